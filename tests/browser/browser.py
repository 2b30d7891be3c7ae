"""A headless Chromium, driven over the DevTools protocol."""
import base64
import json
import pathlib
import subprocess
import tempfile
import time

import websocket


class Browser:
    """One page in a browser of its own; what it logs and asks for is kept."""

    def __init__(self, width=1280, height=900, dark=False, scripts=True, webgl=True):
        self.profile = tempfile.TemporaryDirectory(prefix="traverse-browser-")
        graphics = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"] if webgl else [
            "--disable-gpu", "--disable-3d-apis"]
        self.process = subprocess.Popen(
            ["chromium-headless-shell", "--no-sandbox", "--hide-scrollbars", *graphics,
             "--remote-debugging-port=0", "--remote-allow-origins=*",
             f"--user-data-dir={self.profile.name}", f"--window-size={width},{height}",
             "about:blank"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.problems = []
        self.requests = []
        self.number = 0
        self.socket = websocket.create_connection(self._page_address(), timeout=60)
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=width < 600)
        self.call("Emulation.setEmulatedMedia",
                  features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        if not scripts:
            self.call("Emulation.setScriptExecutionDisabled", value=True)

    def _page_address(self):
        from urllib.request import urlopen
        port_file = pathlib.Path(self.profile.name, "DevToolsActivePort")
        for _ in range(600):
            if port_file.exists() and port_file.read_text().count("\n") >= 1:
                port = port_file.read_text().split()[0]
                targets = json.load(urlopen(f"http://127.0.0.1:{port}/json"))
                for target in targets:
                    if target["type"] == "page":
                        return target["webSocketDebuggerUrl"]
            time.sleep(0.05)
        raise RuntimeError("the browser does not answer")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()
        self.process.terminate()
        self.process.wait(20)
        try:
            self.profile.cleanup()
        except OSError:
            pass

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
        self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            message = json.loads(self.socket.recv())
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

    def screenshot(self, file, whole=False):
        extra = {}
        if whole:
            size = self.call("Page.getLayoutMetrics")["cssContentSize"]
            extra = {"captureBeyondViewport": True,
                     "clip": {"x": 0, "y": 0, "width": size["width"], "height": size["height"],
                              "scale": 1}}
        shot = self.call("Page.captureScreenshot", format="png", **extra)
        pathlib.Path(file).write_bytes(base64.b64decode(shot["data"]))

    def print_pdf(self, file):
        pdf = self.call("Page.printToPDF", preferCSSPageSize=True, printBackground=True)
        pathlib.Path(file).write_bytes(base64.b64decode(pdf["data"]))
