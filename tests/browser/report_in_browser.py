"""report_in_browser.py PROGRAM MAKE_RUN [CASE...]: opens reports in a headless Chromium and uses
them as a reader would. Reports of real recordings need TRAVERSE_TEST_DATA and skip without."""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

from browser import Browser

PROGRAM, MAKE_RUN = sys.argv[1:3]
SOURCE = pathlib.Path(__file__).resolve().parents[2]


def report_of(run, *options):
    subprocess.run([PROGRAM, "report", run, "--no-pictures", *options], check=True,
                   stdout=subprocess.DEVNULL)
    return pathlib.Path(run, "report.html")


def made_report(folder, *options):
    subprocess.run([MAKE_RUN, folder], check=True)
    return report_of(folder, *options)


def is_ready(browser):
    browser.wait("document.documentElement.classList.contains('has-charts')")
    browser.wait("document.documentElement.classList.contains('has-3d')")


def assert_sound(browser, report):
    """No error in the console, no dialog, no request but for the page and what stands in it."""
    assert browser.problems == [], browser.problems
    outside = [url for url in browser.requests
               if url != report.resolve().as_uri() and not url.startswith(("data:", "blob:"))]
    assert outside == [], outside


def pixels(browser):
    """A digest of what the 3-D view shows."""
    return browser.js("""new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => {
        const canvas = document.querySelector('#stage canvas');
        const small = document.createElement('canvas');
        small.width = 64; small.height = 40;
        small.getContext('2d').drawImage(canvas, 0, 0, 64, 40);
        done(small.toDataURL());
    })))""")


def use_page(browser, report):
    """Slider, hover, zoom, colours, point size and a click on the error peak."""
    embedded = json.loads(browser.js("document.getElementById('report-data').textContent"))
    assert embedded == json.loads(report.with_name("report.json").read_text())
    poses = len(embedded["poses"]["time_s"])
    assert browser.js("document.getElementById('stage').dataset.points") == str(
        embedded["scene"]["points"]["count"])
    charts = {chart["id"]: chart for chart in embedded["charts"]}

    first = pixels(browser)
    browser.js("document.getElementById('moment').value = 30;"
               "document.getElementById('moment').dispatchEvent(new Event('input'))")
    assert browser.js("document.getElementById('stage').dataset.pose") == "30"
    assert "frame 30" in browser.js("document.getElementById('moment-text').textContent")
    assert pixels(browser) != first, "the slider moves the vehicle"

    seen = pixels(browser)
    with_error = ["error"] if embedded["scene"]["error_m"] else []
    for colour in ("time", "intensity", *with_error, "height"):
        browser.js(f"document.getElementById('colour').value = '{colour}';"
                   "document.getElementById('colour').dispatchEvent(new Event('change'))")
        assert pixels(browser) != seen, f"the colours change to {colour}"
        assert colour in browser.js("document.getElementById('scales').textContent")
        seen = pixels(browser)
    browser.js("document.getElementById('point-size').value = 5;"
               "document.getElementById('point-size').dispatchEvent(new Event('input'))")
    assert pixels(browser) != seen, "points grow"

    # Hover: the value told is that of the JSON.
    name = "ape" if "ape" in charts else "residual"
    plot = f"#chart-{name} .plot"
    x, y = browser.place(plot, 0.6, 0.5)
    browser.mouse("mouseMoved", x, y)
    row = int(browser.js(f"document.getElementById('chart-{name}').dataset.row"))
    told = browser.js(f"document.querySelector('#chart-{name} .readout b').dataset.value")
    value = charts[name]["series"][0]["values"][row]
    assert float(told) == value, (told, value)
    assert 0.4 * poses < row < 0.8 * poses, row
    others = browser.js("document.querySelector('#chart-timing').dataset.row")
    assert abs(int(others) - row) <= 1, "charts share the cursor"

    # A click on the peak takes the page there.
    values = [v if v is not None else -1 for v in charts[name]["series"][0]["values"]]
    peak = max(range(len(values)), key=values.__getitem__)
    before = browser.js("traverse.camera().target")
    place = browser.js(f"""(() => {{
        const canvas = document.querySelector('{plot} canvas').getBoundingClientRect();
        const mark = document.querySelector('#chart-{name} .moment-mark');
        traverse.look({peak}, 'test');
        const at = parseFloat(mark.style.left) / canvas.width;
        traverse.look(0, 'test');
        return at;
    }})()""")
    start = browser.js("traverse.camera().target")
    browser.click(plot, place, 0.5)
    pose = (charts[name]["pose"] or list(range(poses)))[peak]
    assert browser.js("traverse.pose") == pose, (browser.js("traverse.pose"), pose)
    assert browser.js("document.getElementById('stage').dataset.pose") == str(pose)
    assert browser.js("document.getElementById('moment').value") == str(pose)
    assert browser.js("traverse.camera().target") != start, "the camera went there"
    assert before is not None

    # Dragging zooms every chart over the same axis; a double click shows all again.
    x, y = browser.place(plot, 0.3, 0.5)
    browser.mouse("mouseMoved", x, y)
    browser.mouse("mousePressed", x, y, button="left", clickCount=1)
    browser.mouse("mouseMoved", x + 150, y, button="left", buttons=1)
    browser.mouse("mouseReleased", x + 150, y, button="left", clickCount=1)
    labels = ("[...document.querySelectorAll('#chart-timing .dygraph-axis-label-x')]"
              ".map((label) => label.textContent).join()")
    zoomed = browser.js(labels)
    for count in (1, 2):
        browser.mouse("mousePressed", x, y, button="left", clickCount=count)
        browser.mouse("mouseReleased", x, y, button="left", clickCount=count)
    assert browser.js(labels) != zoomed, "zooming is shared"

    # A frame of the worst segments leads there.
    browser.click("#worst td[data-pose] button")
    asked = browser.js("document.querySelector('#worst td[data-pose]').dataset.pose")
    assert browser.js("String(traverse.pose)") == asked

    # Measuring between two points of the map.
    browser.js("document.getElementById('from-above').click();"
               "document.getElementById('measure').click()")
    browser.click("#stage", 0.45, 0.5)
    browser.click("#stage", 0.55, 0.5)
    return browser.js("document.getElementById('measured').textContent")


def cells_of(text):
    def value(cell):
        try:
            return float(cell)
        except ValueError:
            return cell
    return [[value(cell) for cell in row] for row in csv.reader(text.splitlines())]


def export_tables(browser, folder):
    """The buttons of a table give what the command writes."""
    browser.js("URL.createObjectURL = (blob) => { window.saved = blob; return 'data:,'; }")
    for table in ("ape", "configuration", "facts", "timing"):
        for number, ending in enumerate(("csv", "tex")):
            browser.js(f"document.querySelectorAll('#table-{table} .exports button')[{number}].click()")
            text = browser.js("window.saved.text()")
            with open(pathlib.Path(folder, f"{table}.{ending}"), newline="") as file:
                written = file.read()
            if ending == "csv":  # the same numbers, though 7e-06 may stand for 0.000007
                assert cells_of(text) == cells_of(written), table
            else:
                assert text == written, (table, text, written)


def assert_numbers_are_written_alike(browser):
    """Scripts write numbers as the program does: every cell of the page's tables, and ties."""
    wrong = browser.js("""[...document.querySelectorAll('table[data-table] td.n[title]')].filter((cell) => {
        const value = Number(cell.title);
        const text = cell.textContent.replace(/ ±.*/, '');
        return Number.isFinite(value) && text !== traverse.short(value) && text !== traverse.count(value);
    }).map((cell) => `${cell.title}: ${cell.textContent}`)""")
    assert wrong == [], wrong
    for value, text in ((0.125, "0.125"), (12.25, "12.2"), (12.75, "12.8"), (1225000, "1.22e+06"), (106.25, "106.2"),
                        (-2.008, "−2.01"), (1.23e-5, "1.23e-05"), (0, "0")):
        assert browser.js(f"traverse.short({value})") == text, (value, browser.js(f"traverse.short({value})"))
    assert browser.js("traverse.count(12345)") == "12\u2009345"


def test_made_run(folder):
    report = made_report(folder, "--export", os.path.join(folder, "tables"))
    with Browser() as browser:
        browser.open(report)
        is_ready(browser)
        use_page(browser, report)
        export_tables(browser, os.path.join(folder, "tables"))
        assert_numbers_are_written_alike(browser)
        assert_sound(browser, report)
        assert browser.js("document.querySelectorAll('main script, h1 script').length") == 0
        assert "<script>alert('x')</script>" in browser.js("document.title")


def test_opens_at_a_pose(folder):
    report = made_report(folder)
    with Browser(dark=True) as browser:
        browser.open(report, "#pose=17")
        is_ready(browser)
        assert browser.js("document.getElementById('stage').dataset.pose") == "17"
        assert_sound(browser, report)


def test_without_javascript_or_webgl(folder):
    subprocess.run([MAKE_RUN, folder], check=True)
    subprocess.run([PROGRAM, "report", folder], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    report = pathlib.Path(folder, "report.html")
    seen = "getComputedStyle(document.getElementById('{}')).display"
    with Browser(webgl=False) as browser:
        browser.open(report)
        browser.wait("document.documentElement.classList.contains('has-charts')")
        assert browser.js(seen.format("map-height")) == "block", "a picture in place of the view"
        assert browser.js(seen.format("view-3d")) == "none"
        assert browser.js(seen.format("error-over-time")) == "none", "charts need no WebGL"
        assert_sound(browser, report)
    with Browser(scripts=False) as browser:
        browser.open(report)
        for picture in ("map-height", "error-over-time", "health-over-time"):
            assert browser.js(seen.format(picture)) == "block", picture
    with Browser() as browser:
        browser.open(report)
        is_ready(browser)
        assert browser.js(seen.format("map-height")) == "none", "the view in place of the picture"
        browser.call("Emulation.setEmulatedMedia", media="print")
        assert browser.js(seen.format("map-height")) == "block", "pictures are printed"
        assert browser.js(seen.format("stage")) == "none"


def test_narrow(folder):
    report = made_report(folder)
    with Browser(width=390, height=800, dark=True) as browser:
        browser.open(report)
        is_ready(browser)
        assert browser.js("document.documentElement.scrollWidth") <= 390, "nothing sticks out"
        assert_sound(browser, report)


def test_opens_fast(folder):
    subprocess.run([MAKE_RUN, folder, "5000", "1000000"], check=True)
    report = report_of(folder)
    assert report.stat().st_size < 12e6, report.stat().st_size
    with Browser() as browser:
        browser.open(report)
        is_ready(browser)
        assert_sound(browser, report)


def test_compared_runs(folder):
    runs = [os.path.join(folder, name) for name in ("a", "b")]
    for run in runs:
        subprocess.run([MAKE_RUN, run], check=True)
    page = pathlib.Path(folder, "compare.html")
    subprocess.run([PROGRAM, "compare", *runs, "-o", str(page)], check=True, stdout=subprocess.DEVNULL)
    with Browser() as browser:
        browser.open(page)
        browser.wait("document.documentElement.classList.contains('has-charts')")
        sections = browser.js("[...document.querySelectorAll('main > section')].map((s) => s.id)")
        assert sections == ["verdict", "trajectories", "errors", "stretches", "settings"], sections
        assert browser.js("[...document.querySelectorAll('nav a')].map((a) => a.getAttribute('href').slice(1))") == sections
        assert_numbers_are_written_alike(browser)
        x, y = browser.place("#chart-ape_rmse_m .plot", 0.5, 0.5)
        browser.mouse("mouseMoved", x, y)
        assert len(browser.js("[...document.querySelectorAll('#chart-ape_rmse_m .readout b')].map((b) => b.dataset.value)")) == 2
        assert_sound(browser, page)


BATCH = """recordings:
  - {simulate: town_short, arguments: {first: 60, duration: 1.5}, seeds: [1, 2]}
pipelines: [floam]
grid: {solver.huber_m: [0.1, 0.2]}
repeats: 3
reports: false
metrics: [ape_translation_rmse, mme, frame_median_ms]
tables: [{title: As asked, text: Words above it.}]
"""


def painted(browser, chart):
    """How many pixels of a chart's canvases are not empty."""
    return browser.js(f"""[...document.querySelectorAll('{chart} canvas')].map((canvas) => {{
        const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
        let painted = 0;
        for (let i = 3; i < data.length; i += 4) painted += data[i] > 0;
        return painted;
    }}).reduce((a, b) => a + b, 0)""")


def choose(browser, name, value):
    browser.js(f"(() => {{ const choice = document.querySelector('[data-choice=\"{name}\"]');"
               f"choice.value = '{value}'; choice.dispatchEvent(new Event('change')); }})()")


def test_batch(folder):
    plan = pathlib.Path(folder, "plan.yaml")
    plan.write_text(BATCH)
    subprocess.run([PROGRAM, "batch", str(plan), "-o", os.path.join(folder, "out")], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    page = pathlib.Path(folder, "out/batch.html")
    with Browser() as browser:
        browser.open(page)
        browser.wait("document.documentElement.classList.contains('has-charts')")
        runs = json.loads(browser.js("document.getElementById('report-data').textContent"))["runs"]
        assert len(runs) == 12
        shown = "document.querySelectorAll('[data-content=\"runs\"] tbody tr').length"
        assert browser.js(shown) == 12
        browser.js("(() => { const filter = document.querySelector('[data-content=\"runs\"] input');"
                   "filter.value = 'seed2 huber_m=0.1'; filter.dispatchEvent(new Event('input')); })()")
        assert browser.js(shown) == 3
        assert "3 of 12 rows" in browser.js("document.querySelector('[data-content=\"runs\"] .count').textContent")
        heads = "document.querySelectorAll('[data-content=\"matrix\"] th')"
        browser.js(f"{heads}[1].querySelector('button').click()")
        column = browser.js("[...document.querySelectorAll('[data-content=\"matrix\"] tbody tr')].map((row) => Number(row.cells[1].title))")
        assert column == sorted(column) and len(column) == 2, column
        assert browser.js("document.querySelector('#tables h4').textContent") == "As asked"
        assert len(browser.js("[...document.querySelectorAll('#tables table')].map((t) => t.id)")) == 2, "a recording each"

        # Boxes: painted, read out under the pointer, and other ones on another choice.
        before = painted(browser, "#boxes")
        assert before > 500, before
        value = runs[0]["values"][0]
        x, y = browser.place("#boxes .plot", 0.3, 0.5)
        browser.mouse("mouseMoved", x, y)
        told = browser.js("[...document.querySelectorAll('#boxes .readout b')].map((b) => Number(b.dataset.value))")
        assert len(told) == 4 and told[2] <= told[1] <= told[3], told
        assert any(abs(told[0] - run["values"][0]) < 1e-12 for run in runs), (told, value)
        choose(browser, "scale", "log")
        assert painted(browser, "#boxes") != before
        choose(browser, "groups", "all")
        assert browser.js("[...document.querySelectorAll('#boxes .dygraph-axis-label-x')].map((l) => l.textContent)") == ["all recordings"]

        # The sweep: a line for the mean and one for each recording, read out at a value of the grid.
        x, y = browser.place("#sweep-chart .plot", 0.95, 0.5)
        browser.mouse("mouseMoved", x, y)
        assert browser.js("document.querySelector('#sweep-chart .where').textContent") == "solver.huber_m 0.2"
        mean = float(browser.js("document.querySelector('#sweep-chart .readout b').dataset.value"))
        last = [run["values"][0] for run in runs if run["variant"] == [
            k for k, v in enumerate(json.loads(browser.js("document.getElementById('report-data').textContent"))["variants"])
            if v["settings"] == ["solver.huber_m=0.2"]][0]]
        assert abs(mean - sum(last) / len(last)) < 1e-12, (mean, last)
        assert_sound(browser, page)


def living(group):
    """The processes of a group that have not ended."""
    found = []
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, process_group = stat.read_text().rpartition(")")[2].split()[:3]
        except OSError:
            continue
        if int(process_group) == group and state != "Z":
            found.append(int(stat.parent.name))
    return found


def test_browser_ends(folder):
    """However a test ends, its browser does too: also when nothing of the test can run any more."""
    code = "import time; from browser import Browser; b = Browser(); print(b.process.pid, flush=True); time.sleep(60)"
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE,
                          cwd=pathlib.Path(__file__).parent, env={**os.environ, "TMPDIR": folder}) as test:
        group = int(test.stdout.readline())
        assert len(living(group)) > 1, "the browser runs"
        test.kill()
    end = time.monotonic() + 30
    while living(group) and time.monotonic() < end:
        time.sleep(0.1)
    assert living(group) == []
    try:
        with Browser() as browser:
            group = browser.process.pid
            raise KeyError
    except KeyError:
        assert living(group) == []


def use_run(run):
    report = report_of(run)
    with Browser() as browser:
        browser.open(report)
        is_ready(browser)
        measured = use_page(browser, report)
        assert " m (x" in measured, measured
        assert_sound(browser, report)


def test_simulated_street(folder):
    recording = str(pathlib.Path(folder, "street.rawlog"))
    quiet = {"check": True, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    subprocess.run([PROGRAM, "simulate", "town_short", "--first", "60",
                    "--duration", "6", "-o", recording], **quiet)
    run = str(pathlib.Path(folder, "run"))
    subprocess.run([PROGRAM, "run", recording, "-o", run, "--no-report"], **quiet)
    use_run(run)


def test_kitti_drives(folder):
    data = SOURCE / "build/data"
    if not data.is_dir():
        print("skipped: no recordings in build/data")
        return
    for drive in ("2011_09_26_drive_0001", "2011_09_26_drive_0005"):
        run = str(pathlib.Path(folder, drive))
        subprocess.run(
            [PROGRAM, "run", str(data / drive), "-o", run, "--no-report", "--no-hash",
             "--recording-config", str(SOURCE / "share/recordings/kitti_raw_drive.yaml"),
             "--reference", str(data / drive / "poses_velo.txt"), "--reference-frame", "lidar"],
            check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        use_run(run)


def main():
    chosen = sys.argv[3:]
    for name, test in list(globals().items()):
        if not name.startswith("test_") or (chosen and name not in chosen):
            continue
        with tempfile.TemporaryDirectory(prefix="traverse-browser-") as folder:
            test(folder)
            print("passed", name, flush=True)


main()
