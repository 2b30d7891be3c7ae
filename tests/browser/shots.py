"""shots.py PAGE.html FOLDER: screenshots of a page's sections, light and dark, wide and narrow, and a
PDF of it as printed."""
import pathlib
import sys

from browser import Browser

page, folder = sys.argv[1], pathlib.Path(sys.argv[2])
folder.mkdir(parents=True, exist_ok=True)
for look, width, dark in (("light", 1280, False), ("dark", 1280, True), ("phone", 390, False),
                          ("phone-dark", 390, True)):
    with Browser(width=width, height=900, dark=dark) as browser:
        seconds = browser.open(page)
        if browser.js("!!document.querySelector('.charts')"):
            browser.wait("document.documentElement.classList.contains('has-charts')")
        if browser.js("!!document.getElementById('stage')"):
            browser.wait("document.documentElement.classList.contains('has-3d')")
        sections = browser.js("[...document.querySelectorAll('main > section[id]')].map((s) => s.id)")
        for name in sections:
            browser.screenshot(folder / f"{look}-{name}.png", f"#{name}")
        if look == "light":
            browser.print_pdf(folder / "print.pdf")
        print(look, f"loaded in {seconds:.2f} s", browser.problems or "no problem")
