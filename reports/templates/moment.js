// The moment of the run that the whole page looks at: one pose of the estimate. Charts, the slider
// and the 3-D view set it and follow it; a link "#pose=32" opens the page there.
"use strict";
(() => {
  const { report, figure } = traverse;
  const poses = report.poses.time_s.length;
  const followers = [];
  let pose = 0;

  traverse.poses = poses;
  Object.defineProperty(traverse, "pose", { get: () => pose });
  traverse.follow = (follower) => followers.push(follower);
  /** Looks at a pose; `source` says who moved it, so that it need not follow itself. */
  traverse.look = (index, source) => {
    pose = Math.min(Math.max(0, Math.round(index)), poses - 1);
    document.documentElement.dataset.pose = pose;
    for (const follower of followers) follower(pose, source);
  };
  traverse.describe = (index) => `frame ${report.poses.frame[index]} · ${figure(report.poses.time_s[index])} s · ` +
    `${figure(report.poses.distance_m[index])} m`;

  // A cell that names a frame takes the page there.
  for (const cell of document.querySelectorAll("td[data-pose]")) {
    const there = Number(cell.dataset.pose);
    const text = cell.textContent;
    cell.replaceChildren(traverse.button(text, () => traverse.look(there, "table")));
    cell.classList.add("moment");
  }
  // When all scripts have run: who follows is there.
  document.addEventListener("DOMContentLoaded", () => {
    const asked = /^#pose=(\d+)$/.exec(window.location.hash);
    traverse.look(asked ? Number(asked[1]) : 0, "start");
  });
})();
