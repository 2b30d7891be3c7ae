"""shots.py REPORT.html FOLDER: screenshots of a report, light and dark, wide and narrow, and a PDF."""
import pathlib
import sys

from browser import Browser

report, folder = sys.argv[1], pathlib.Path(sys.argv[2])
folder.mkdir(parents=True, exist_ok=True)
for name, width, dark in (("light", 1280, False), ("dark", 1280, True), ("phone", 390, False),
                          ("phone-dark", 390, True)):
    with Browser(width=width, height=900, dark=dark) as browser:
        seconds = browser.open(report)
        browser.wait("document.documentElement.classList.contains('has-charts')")
        if browser.js("!!document.getElementById('stage')"):
            browser.wait("document.documentElement.classList.contains('has-3d')")
        browser.screenshot(folder / f"{name}.png", whole=True)
        if name == "light":
            browser.print_pdf(folder / "print.pdf")
        print(name, f"loaded in {seconds:.2f} s", browser.problems or "no problem")
