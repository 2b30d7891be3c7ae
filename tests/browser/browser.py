"""A headless Chromium, driven over the DevTools protocol."""
import base64
import json
import os
import pathlib
import select
import signal
import subprocess
import tempfile
import time


class Browser:
    """One page in a browser of its own; what it logs and asks for is kept.

    It listens on a pipe and ends when that is closed: however this program ends, nothing of the
    browser is left. (Debian's command is a shell script; ending it would leave its children.)"""

    def __init__(self, width=1280, height=900, dark=False, scripts=True, webgl=True):
        self.profile = tempfile.TemporaryDirectory(prefix="traverse-browser-",
                                                   ignore_cleanup_errors=True)
        self.problems = []
        self.requests = []
        self.number = 0
        self.session = None
        self.received = b""
        self._start(width, height, webgl)
        try:
            self._attach(width, height, dark, scripts)
        except BaseException:
            self.close()
            raise

    def _start(self, width, height, webgl):
        graphics = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"] if webgl else [
            "--disable-gpu", "--disable-3d-apis"]
        commands, self.commands = os.pipe()
        self.answers, answers = os.pipe()
        self.process = subprocess.Popen(
            ["sh", "-c", f'exec chromium-headless-shell "$@" 3<&{commands} 4>&{answers}', "sh",
             "--no-sandbox", "--hide-scrollbars", *graphics, "--remote-debugging-pipe",
             f"--user-data-dir={self.profile.name}", f"--window-size={width},{height}",
             "about:blank"], pass_fds=(commands, answers), start_new_session=True,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(commands)
        os.close(answers)

    def _attach(self, width, height, dark, scripts):
        targets = self.call("Target.getTargets")["targetInfos"]
        page = next(target for target in targets if target["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=page["targetId"],
                                 flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=width < 600)
        self.call("Emulation.setEmulatedMedia",
                  features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        if not scripts:
            self.call("Emulation.setScriptExecutionDisabled", value=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        os.close(self.commands)
        os.close(self.answers)
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()
        self.profile.cleanup()

    def _send(self, message):
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.commands, data):]

    def _receive(self, seconds=120):
        """The next message; on the pipe they end in a zero byte."""
        end = time.monotonic() + seconds
        while b"\0" not in self.received:
            if not select.select([self.answers], [], [], max(0, end - time.monotonic()))[0]:
                raise RuntimeError("the browser does not answer")
            part = os.read(self.answers, 1 << 20)
            if not part:
                raise RuntimeError("the browser has ended")
            self.received += part
        message, _, self.received = self.received.partition(b"\0")
        return json.loads(message)

    def _take(self, message):
        method = message.get("method")
        if method == "Runtime.exceptionThrown":
            details = message["params"]["exceptionDetails"]
            self.problems.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Runtime.consoleAPICalled" and message["params"]["type"] in (
                "error", "warning", "assert"):
            self.problems.append(" ".join(str(a.get("value", a.get("description")))
                                          for a in message["params"]["args"]))
        elif method == "Log.entryAdded" and message["params"]["entry"]["level"] == "error":
            self.problems.append(message["params"]["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            self.requests.append(message["params"]["request"]["url"])
        elif method == "Page.javascriptDialogOpening":
            self.problems.append("a dialog opened: " + message["params"]["message"])

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        self._send(message)
        while True:
            message = self._receive()
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']['message']}")
                return message["result"]
            self._take(message)

    def open(self, file, fragment=""):
        began = time.monotonic()
        self.call("Page.navigate", url=pathlib.Path(file).resolve().as_uri() + fragment)
        self.wait("document.readyState === 'complete'")
        return time.monotonic() - began

    def js(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True,
                           awaitPromise=True)
        if "exceptionDetails" in result:
            details = result["exceptionDetails"]
            raise AssertionError(details.get("exception", {}).get("description", details["text"]))
        return result["result"].get("value")

    def wait(self, expression, seconds=60):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if self.js(expression):
                return
            time.sleep(0.05)
        raise AssertionError(f"never true: {expression}")

    def place(self, selector, x=0.5, y=0.5):
        """Scrolls there; where a share of the element's width and height is in the window."""
        self.js(f"document.querySelector({json.dumps(selector)}).scrollIntoView({{block:'center',behavior:'instant'}})")
        box = self.js(f"(({{left,top,width,height}}) => [left,top,width,height])"
                      f"(document.querySelector({json.dumps(selector)}).getBoundingClientRect())")
        return box[0] + x * box[2], box[1] + y * box[3]

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def click(self, selector, x=0.5, y=0.5):
        px, py = self.place(selector, x, y)
        self.mouse("mouseMoved", px, py)
        self.mouse("mousePressed", px, py, button="left", clickCount=1)
        self.mouse("mouseReleased", px, py, button="left", clickCount=1)

    def screenshot(self, file, selector=None):
        """Of the window, or of an element as a whole."""
        extra = {}
        if selector:
            box = self.js(f"""(() => {{
                const box = document.querySelector({json.dumps(selector)}).getBoundingClientRect();
                return {{x: 0, y: box.top + scrollY, width: innerWidth, height: box.height, scale: 1}};
            }})()""")
            extra = {"captureBeyondViewport": True, "clip": box}
        shot = self.call("Page.captureScreenshot", format="png", **extra)
        pathlib.Path(file).write_bytes(base64.b64decode(shot["data"]))

    def print_pdf(self, file):
        pdf = self.call("Page.printToPDF", preferCSSPageSize=True, printBackground=True)
        pathlib.Path(file).write_bytes(base64.b64decode(pdf["data"]))
