"""opening_bench.py REPORT.html...: how large a page is and how long it takes to open, charts and 3-D
view drawn: the median of five fresh browsers, and what the page's own scripts took of it."""
import pathlib
import statistics
import sys
import time

from browser import Browser

for report in sys.argv[1:]:
    seconds, busy = [], []
    for _ in range(5):
        with Browser() as browser:
            browser.call("Performance.enable", timeDomain="threadTicks")
            began = time.monotonic()
            browser.open(report)
            browser.wait("document.documentElement.classList.contains('has-charts')")
            browser.wait("document.documentElement.classList.contains('has-3d')")
            # The first picture of the view is on the screen.
            browser.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
            seconds.append(time.monotonic() - began)
            metrics = {m["name"]: m["value"] for m in browser.call("Performance.getMetrics")["metrics"]}
            busy.append(metrics["TaskDuration"])
    print(f"{report}: {pathlib.Path(report).stat().st_size / 1e6:.1f} MB, opens in "
          f"{statistics.median(seconds):.2f} s ({min(seconds):.2f} to {max(seconds):.2f}), of which the "
          f"page's processor time {statistics.median(busy):.2f} s")
