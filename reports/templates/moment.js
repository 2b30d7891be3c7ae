// The moment of the run that the whole page looks at: one pose of the estimate. Charts, the slider
// and the 3-D view set it and follow it; a link "#pose=32" opens the page there.
"use strict";
const traverse = (() => {
  const report = JSON.parse(document.getElementById("report-data").textContent);
  const poses = report.poses.time_s.length;
  const followers = [];
  let pose = 0;

  // As number_text.cpp has it: three or four digits, a true minus sign.
  const short = (value) => {
    if (value === null || !Number.isFinite(value)) return "–";
    if (Number.isInteger(value) && Math.abs(value) < 1e6) return String(value).replace("-", "−");
    const size = Math.abs(value);
    const text = size >= 1e6 || size < 1e-4 ? value.toExponential(2)
      : size >= 100 ? value.toFixed(1)
      : value.toFixed(Math.max(0, 2 - Math.floor(Math.log10(size))));
    return text.replace("-", "−");
  };

  return {
    report, poses, short,
    get pose() { return pose; },
    follow(follower) { followers.push(follower); },
    /** Looks at a pose; `source` says who moved it, so that it need not follow itself. */
    look(index, source) {
      pose = Math.min(Math.max(0, Math.round(index)), poses - 1);
      document.documentElement.dataset.pose = pose;
      for (const follower of followers) follower(pose, source);
    },
    describe(index) {
      return `frame ${report.poses.frame[index]} · ${short(report.poses.time_s[index])} s · ` +
        `${short(report.poses.distance_m[index])} m`;
    },
    dark: window.matchMedia("(prefers-color-scheme: dark)"),
  };
})();
