// Charts of the batch page: box plots and sweeps, and the choices above them.
"use strict";
const MOST_BOXES = 60;

/** Linear between neighbours, as statistics::quantile(). */
function quantile(sorted, share) {
  const place = share * (sorted.length - 1);
  const below = Math.floor(place);
  return sorted[below] + (place - below) * ((sorted[below + 1] ?? sorted[below]) - sorted[below]);
}

/** What cannot be negative starts at zero unless that would hide the differences. */
function startsAtZero(values) {
  return Math.min(...values) >= 0 && Math.min(...values) < 0.5 * Math.max(...values);
}

/** A sentence in place of a chart. */
function say(figure, text) {
  figure.replaceChildren(traverse.element("p", "how", text));
}

/** A box at slot `x`: quartiles, and whiskers to the farthest values within 1.5 box heights. */
function boxOf(values, x) {
  const sorted = [...values].sort((a, b) => a - b);
  const [q1, q2, q3] = [0.25, 0.5, 0.75].map((share) => quantile(sorted, share));
  const reach = 1.5 * (q3 - q1);
  return { x, sorted, q1, q2, q3, low: sorted.find((v) => v >= q1 - reach), high: [...sorted].reverse().find((v) => v <= q3 + reach) };
}

/** Where the dots of a box stand within it, so that equal ones do not hide each other. */
const dotsOf = (box) => box.sorted.map((value, i) => [box.x + 0.44 * box.half * (((i * 7) % 5) / 2 - 1), value]);

/** Draws the boxes on dygraphs' canvas, in its coordinates. */
function paintBoxes(boxes) {
  return ({ drawingContext: canvas, dygraph }) => {
    const across = (x) => dygraph.toDomXCoord(x);
    const up = (value) => dygraph.toDomYCoord(value);
    const line = (x1, y1, x2, y2) => {
      canvas.beginPath();
      canvas.moveTo(x1, y1);
      canvas.lineTo(x2, y2);
      canvas.stroke();
    };
    canvas.save();
    for (const box of boxes) {
      const x = across(box.x);
      const half = across(box.x + box.half) - x;
      canvas.strokeStyle = box.colour;
      canvas.fillStyle = box.colour;
      canvas.lineWidth = 2;
      line(x, up(box.low), x, up(box.q1));
      line(x, up(box.q3), x, up(box.high));
      canvas.globalAlpha = 0.2;
      canvas.fillRect(x - half, up(box.q3), 2 * half, up(box.q1) - up(box.q3));
      canvas.globalAlpha = 1;
      canvas.strokeRect(x - half, up(box.q3), 2 * half, up(box.q1) - up(box.q3));
      canvas.lineWidth = 3;
      line(x - half, up(box.q2), x + half, up(box.q2));
      for (const [dx, value] of dotsOf(box)) {
        canvas.beginPath();
        canvas.arc(across(dx), up(value), 2, 0, 2 * Math.PI);
        canvas.fill();
      }
    }
    canvas.restore();
  };
}

// What a box stands for, and which of them a run belongs to.
function boxesOf(boxesBy) {
  const names = boxesBy === "pipeline" ? data.pipelines : data.variants.map((variant) => variant.name);
  return { names, of: (run) => (boxesBy === "pipeline" ? data.pipelines.indexOf(data.variants[run.variant].pipeline) : run.variant) };
}

function drawBoxes(metricIndex, boxesBy, groupsBy, scale) {
  const metric = data.metrics[metricIndex];
  const boxes = boxesOf(boxesBy);
  const groupNames = groupsBy === "all" ? ["all recordings"] : data.recordings;
  const groups = groupNames.map(() => boxes.names.map(() => []));
  for (const run of okRuns(null, null)) {
    const value = run.values[metricIndex];
    if (value !== null) groups[groupsBy === "all" ? 0 : run.recording][boxes.of(run)].push(value);
  }
  drawGroups(document.getElementById("boxes"), metric, groups, groupNames, boxes.names, scale);
}

function drawLengths(lengths, boxesBy, scale) {
  const figure = document.getElementById("length-boxes");
  const kitti = lengths === "kitti";
  const all = kitti ? data.lengths.kitti_m.map((metres) => `${metres} m`) : data.lengths.share_percent.map((share) => `${share} %`);
  const first = kitti ? 0 : data.lengths.kitti_m.length;
  const boxes = boxesOf(boxesBy);
  const groups = all.map((name, k) => {
    const group = boxes.names.map(() => []);
    for (const run of okRuns(null, null)) {
      const value = run.drift?.[first + k] ?? null;
      if (value !== null) group[boxes.of(run)].push(value);
    }
    return { name, group };
  }).filter(({ group }) => group.some((values) => values.length));
  drawGroups(figure, { title: "Drift", unit: "%" }, groups.map(({ group }) => group), groups.map(({ name }) => name), boxes.names, scale);
}

function drawGroups(figure, metric, groups, groupNames, boxNames, scale) {
  const all = groups.flat(2);
  if (!all.length) {
    say(figure, `No run that is ok has ${metric.title}.`);
    return;
  }
  if (boxNames.length > MOST_BOXES) {
    say(figure, `${boxNames.length} boxes a group are too many to read: choose pipelines with all settings together, or see the sweep.`);
    return;
  }
  const span = boxNames.length + 1;  // slots of a group, with a gap
  const width = 64 + groups.length * span * 18;
  const half = Math.min(0.35, 18 / (Math.max(width, figure.clientWidth - 80) / (groups.length * span)));
  const boxes = groups.flatMap((group, g) => group.map((values, b) => (values.length === 0 ? null
    : { ...boxOf(values, g * span + b + 0.5), half, name: boxNames[b], group: groupNames[g], colour: traverse.colour(b) })).filter(Boolean));
  const rows = boxes.flatMap((box) => dotsOf(box).map(([x, value]) => ({ x, value, box }))).sort((a, b) => a.x - b.x);
  const chart = traverse.chart(figure, withUnit(metric), "", `Box plots of ${metric.title}`);
  figure.prepend(traverse.legend(boxNames));
  chart.plot.style.minWidth = `${Math.max(640, width)}px`;
  chart.draw(rows.map(({ x, value }) => [x, value]), {
    labels: ["x", metric.title], colors: ["#8a8f98"], plotter: paintBoxes(boxes), drawPoints: false, highlightCircleSize: 4,
    logscale: scale === "log" && Math.min(...all) > 0, includeZero: startsAtZero(all),
    dateWindow: [-0.5, groups.length * span - 0.5], yRangePad: 12,
    axes: { x: {
      drawGrid: false, axisLabelWidth: Math.max(24, Math.floor(Math.max(width, figure.clientWidth - 80) / groups.length) - 8),
      ticker: () => groupNames.map((label, g) => ({ v: g * span + boxNames.length / 2, label: traverse.escapeHtml(label) })),
    } },
    highlightCallback: (event, x, points, row) => {
      const { box, value } = rows[row];
      const tell = (name, figureOf) => ({ colour: box.colour, name, value: figureOf, unit: metric.unit });
      chart.tell(`${box.name}, ${box.group}, ${box.sorted.length} run${box.sorted.length === 1 ? "" : "s"}`,
        [tell("here", value), tell("median", box.q2), tell("quartiles", box.q1), tell("and", box.q3)]);
    },
    unhighlightCallback: () => chart.tell(null),
  });
  traverse.forgetGraphs();
}

// Accuracy against time: a point a pipeline and setting, and the line of those that none beats in both.
function drawFront() {
  const figure = document.getElementById("front");
  if (!figure) return;
  const ranked = [...(data.ranking ?? [])].sort((a, b) => a.wall_s - b.wall_s || a.value - b.value);
  if (ranked.length < 2) {
    figure.remove();
    return;
  }
  const metric = data.metrics[0];
  const values = ranked.map((one) => one.value);
  const chart = traverse.chart(figure, `${withUnit(metric)} against wall time`, "wall time of a run [s], mean over the recordings", `${metric.title} against wall time`);
  figure.prepend(traverse.legend(ranked.map((one) => one.name)));
  const labels = ["wall time", ...ranked.map((one, k) => `${k}`), "front"];
  const rows = ranked.map((one, k) => [one.wall_s, ...ranked.map((other, j) => (j === k ? one.value : null)), one.front ? one.value : null]);
  chart.draw(rows, {
    labels, colors: [...ranked.map((one, k) => traverse.colour(k)), "#8a8f99"], drawPoints: true, pointSize: 5, strokeWidth: 0,
    connectSeparatedPoints: true, logscale: Math.min(...values) > 0 && Math.max(...values) > 20 * Math.min(...values),
    series: { front: { strokeWidth: 1, strokePattern: [4, 4], pointSize: 1 } }, xRangePad: 24, yRangePad: 18,
    highlightCallback: (event, x, points, row) => chart.tell(ranked[row].name,
      [{ colour: traverse.colour(row), name: metric.title, value: ranked[row].value, unit: metric.unit },
        { colour: traverse.colour(row), name: "wall time", value: ranked[row].wall_s, unit: "s" }]),
    unhighlightCallback: () => chart.tell(null),
  });
}

// The grid's parameters with the values that variants have, in the order of the plan.
function gridParameters() {
  const parameters = new Map();
  for (const variant of data.planned_variants) {
    for (const setting of variant) {
      const at = setting.indexOf("=");
      const key = setting.slice(0, at);
      if (!parameters.has(key)) parameters.set(key, []);
      const values = parameters.get(key);
      if (!values.includes(setting.slice(at + 1))) values.push(setting.slice(at + 1));
    }
  }
  return parameters;
}

function drawSweep(key, metricIndex) {
  const figure = document.getElementById("sweep-chart");
  const metric = data.metrics[metricIndex];
  const texts = gridParameters().get(key);
  const numeric = texts.every((text) => text !== "" && Number.isFinite(Number(text)));
  const places = numeric ? [...texts].sort((a, b) => a - b) : texts;
  const variantsAt = (pipeline, text) => data.variants.map((variant, v) => [variant, v])
    .filter(([variant]) => variant.pipeline === pipeline && variant.settings.includes(`${key}=${text}`)).map(([, v]) => v);
  const lines = [];
  data.pipelines.forEach((pipeline, p) => {
    const perRecording = data.recordings.map((name, r) => places.map((text) =>
      mean(variantsAt(pipeline, text).map((v) => mean(okRuns(r, v).map((run) => run.values[metricIndex]))))));
    perRecording.forEach((values, r) => lines.push({ values, p, name: `${pipeline}, ${data.recordings[r]}`, thin: true }));
    lines.push({ values: places.map((text, i) => mean(perRecording.map((values) => values[i]))), p, name: pipeline, thin: false });
  });
  const all = lines.flatMap((line) => line.values).filter((value) => value !== null);
  if (!all.length) {
    say(figure, `No run that is ok has ${metric.title}.`);
    return;
  }
  const chart = traverse.chart(figure, withUnit(metric), key, `${metric.title} over ${key}`);
  figure.prepend(traverse.legend(data.pipelines));
  const xs = places.map((text, i) => (numeric ? Number(text) : i));
  const colour = (line) => traverse.colour(line.p) + (line.thin ? "73" : "");
  chart.draw(xs.map((x, i) => [x, ...lines.map((line) => line.values[i])]), {
    labels: [key, ...lines.map((line) => line.name)], colors: lines.map(colour), connectSeparatedPoints: true, drawPoints: true,
    includeZero: startsAtZero(all), xRangePad: 24, yRangePad: 12,
    series: Object.fromEntries(lines.map((line) => [line.name, line.thin ? { strokeWidth: 1, pointSize: 2 } : { strokeWidth: 3, pointSize: 4 }])),
    axes: { x: { ticker: () => xs.map((x, i) => ({ v: x, label: traverse.escapeHtml(places[i]) })) } },
    highlightCallback: (event, x, points, row) => chart.tell(`${key} ${places[row]}`, lines.filter((line) => !line.thin)
      .map((line) => ({ colour: traverse.colour(line.p), name: line.name, value: line.values[row], unit: metric.unit }))),
    unhighlightCallback: () => chart.tell(null),
  });
  traverse.forgetGraphs();
}

// Choices of one name stand in several places and hold the same.
const choice = {};
function fill(name, entries) {
  for (const select of document.querySelectorAll(`[data-choice="${name}"]`)) {
    if (entries) select.innerHTML = entries.map(([value, text]) => `<option value="${escapeHtml(value)}">${escapeHtml(text)}</option>`).join("");
    choice[name] = select.value;
    select.addEventListener("change", () => {
      choice[name] = select.value;
      for (const other of document.querySelectorAll(`[data-choice="${name}"]`)) other.value = select.value;
      redraw(name);
    });
  }
}

const views = [
  { needs: ["metric"], draw: () => drawMatrix(Number(choice.metric)) },
  { needs: ["recording"], draw: () => drawRecording(Number(choice.recording)) },
  { needs: ["variant"], draw: () => drawPipeline(Number(choice.variant)) },
  { needs: ["metric", "boxes", "groups", "scale"], draw: () => drawBoxes(Number(choice.metric), choice.boxes, choice.groups, choice.scale) },
  { needs: ["lengths", "boxes", "scale"], draw: () => drawLengths(choice.lengths, choice.boxes, choice.scale) },
  { needs: ["parameter", "metric"], draw: () => choice.parameter && drawSweep(choice.parameter, Number(choice.metric)) },
];
function redraw(changed) {
  for (const view of views) {
    if (changed === undefined || view.needs.includes(changed)) view.draw();
  }
}

fill("metric", data.metrics.map((metric, k) => [k, withUnit(metric)]));
fill("recording", data.recordings.map((name, r) => [r, name]));
fill("variant", data.variants.map((variant, v) => [v, variant.name]));
fill("parameter", [...gridParameters().keys()].map((key) => [key, key]));
fill("boxes");
fill("groups");
fill("scale");
fill("lengths");
drawLeaderboard();
drawFront();
drawBaseline();
redraw();
drawRuns();
document.documentElement.classList.add("has-charts");
