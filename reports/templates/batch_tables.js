// Tables of the batch page, from its numbers: what stands in them; tables.js makes them.
"use strict";
const { report: data, escapeHtml, short: shortNumber } = traverse;
const RUNS_AT_FIRST = 500;

function withUnit(metric) {
  return metric.unit ? `${metric.title} [${metric.unit}]` : metric.title;
}

function mean(values) {
  const known = values.filter((value) => value !== null);
  return known.length ? known.reduce((a, b) => a + b, 0) / known.length : null;
}

/** The table of that name; see traverse.drawTable. */
function drawTable(name, title, columns, rows, options) {
  traverse.drawTable(document.querySelector(`[data-content="${name}"]`), title, columns, rows, options);
}

// The columns of the metrics; KITTI's, where `kitti` is set, once for each of the two averages.
function metricColumns(kitti) {
  const columns = [];
  data.metrics.forEach((metric, k) => {
    const column = { numeric: true, lower: metric.lower };
    const averages = { kitti_translation_percent: "translation", kitti_rotation_deg_per_m: "rotation" }[metric.key];
    if (kitti && averages) {
      columns.push({ ...column, head: `${metric.title}, all segments [${metric.unit}]`, of: (means, kittis) => kittis?.[averages].all_segments ?? null });
      columns.push({ ...column, head: `${metric.title}, mean of recordings [${metric.unit}]`, of: (means, kittis) => kittis?.[averages].per_recording ?? null });
    } else {
      columns.push({ ...column, head: withUnit(metric), of: (means) => means[k] });
    }
  });
  return columns;
}

function drawLeaderboard() {
  const columns = metricColumns(true);
  const rows = data.variants.map((variant, i) => ({
    cells: [i + 1, variant.name, { value: variant.ok, html: `${variant.ok}/${variant.runs}` },
      ...(data.budgets.length ? [variant.over_budget] : []), ...columns.map((column) => column.of(variant.means, variant.kitti))],
  }));
  drawTable("leaderboard", "Means over recordings of runs that are ok", [{ head: "#", numeric: true, count: true }, { head: "Pipeline", name: true },
    { head: "Runs ok", numeric: true }, ...(data.budgets.length ? [{ head: "Over budget", numeric: true, count: true }] : []), ...columns],
  rows, { best: true, atFirst: RUNS_AT_FIRST });
}

// Runs that are ok of a recording and a variant; both null for all.
const okByPlace = new Map();
for (const run of data.runs) {
  if (run.outcome !== "ok" && run.outcome !== "degraded") continue;
  const key = `${run.recording} ${run.variant}`;
  if (!okByPlace.has(key)) okByPlace.set(key, []);
  okByPlace.get(key).push(run);
}
function okRuns(recording, variant) {
  if (recording === null) return [...okByPlace.values()].flat();
  return okByPlace.get(`${recording} ${variant}`) ?? [];
}
const meansOf = (runs) => data.metrics.map((metric, k) => mean(runs.map((run) => run.values[k])));

// How far a value is on the way from the best of its column to the worst, in six steps: 0 the best.
function heatOf(value, column, lower) {
  const known = column.filter((other) => other !== null);
  if (value === null || known.length < 2) return "";
  const scale = known.every((other) => other > 0) ? Math.log : (number) => number;
  const [best, worst] = [Math.min, Math.max].map((pick) => scale(pick(...known)));
  if (best === worst) return "";
  const share = (scale(value) - best) / (worst - best);
  return `heat${Math.round(5 * (lower ? share : 1 - share))}`;
}

// The first run of a recording and a variant that is not ok, as a link to it.
const badByPlace = new Map();
for (const run of data.runs) {
  const key = `${run.recording} ${run.variant}`;
  if (run.outcome === null || run.outcome === "ok" || run.outcome === "degraded" || badByPlace.has(key)) continue;
  badByPlace.set(key, run);
}
function whyMissing(recording, variant) {
  const run = badByPlace.get(`${recording} ${variant}`);
  if (!run || run.folder === null) return run ? { value: null, html: escapeHtml(run.outcome) } : { value: null };
  return { value: null, html: `<a href="${escapeHtml(run.folder)}/${run.report ? "report.html" : data.logs ? "log.txt" : "run.json"}">${escapeHtml(run.outcome)}</a>` };
}

function drawMatrix(metric) {
  const columns = data.recordings.map((recording, r) => data.variants.map((variant, v) => mean(okRuns(r, v).map((run) => run.values[metric]))));
  const { lower } = data.metrics[metric];
  const rows = data.variants.map((variant, v) => ({
    cells: [variant.name, ...columns.map((column, r) => (column[v] === null ? whyMissing(r, v) : { value: column[v], className: heatOf(column[v], column, lower) }))],
  }));
  drawTable("matrix", withUnit(data.metrics[metric]), [{ head: "Pipeline", name: true },
    ...data.recordings.map((name) => ({ head: name, numeric: true, lower: data.metrics[metric].lower }))], rows, { best: true, atFirst: RUNS_AT_FIRST });
}

function drawRecording(recording) {
  const columns = metricColumns(false);
  const rows = data.variants.map((variant, v) => {
    const means = meansOf(okRuns(recording, v));
    return { cells: [variant.name, ...columns.map((column) => column.of(means))] };
  });
  drawTable("recording", data.recordings[recording], [{ head: "Pipeline", name: true }, ...columns], rows, { best: true, atFirst: RUNS_AT_FIRST });
}

function drawPipeline(variant) {
  const columns = metricColumns(false);
  const rows = data.recordings.map((name, r) => {
    const means = meansOf(okRuns(r, variant));
    return { cells: [name, ...columns.map((column) => column.of(means))] };
  });
  const summary = data.variants[variant];
  rows.push({ last: true, cells: ["Mean of recordings", ...data.metrics.map((metric, k) => summary.means[k])] });
  if (summary.kitti) {
    rows.push({ last: true, cells: [`All ${summary.kitti.segments} segments (KITTI benchmark)`, ...data.metrics.map((metric) =>
      metric.key === "kitti_translation_percent" ? summary.kitti.translation.all_segments
        : metric.key === "kitti_rotation_deg_per_m" ? summary.kitti.rotation.all_segments : null)] });
  }
  drawTable("pipeline", summary.name, [{ head: "Recording", name: true }, ...columns], rows);
}

function drawRuns() {
  const rows = data.runs.map((run) => ({
    cells: [data.recordings[run.recording], data.variants[run.variant].name, run.repeat,
      { value: run.outcome ?? "not made", html: `<span class="outcome ${run.outcome === "ok" || run.outcome === "degraded" ? run.outcome : "bad"}">${escapeHtml(run.outcome ?? "not made")}</span>` },
      ...run.values.map((value, k) => ({ value, className: data.budgets.some((budget) => budget.metric === data.metrics[k].key && value !== null && (data.metrics[k].higher ? value < budget.most : value > budget.most)) ? "over" : "" })),
      { value: run.folder ?? "", html: run.folder === null ? "–"
        : `<a href="${escapeHtml(run.folder)}/${run.report ? "report.html" : "run.json"}">${run.report ? "report" : "run.json"}</a>${data.logs ? ` · <a href="${escapeHtml(run.folder)}/log.txt">log</a>` : ""}` }],
  }));
  drawTable("runs", "Runs", [{ head: "Recording", name: true }, { head: "Pipeline", name: true }, { head: "Repeat", numeric: true, count: true }, { head: "Outcome" },
    ...data.metrics.map((metric) => ({ head: withUnit(metric), numeric: true, lower: metric.lower })), { head: "Files" }], rows, { atFirst: RUNS_AT_FIRST });
}

function drawBaseline() {
  if (!data.baseline) return;
  const verdict = (word) => ({ value: word, html: `<span class="verdict ${word.replace(" ", "-")}">${word}</span>` });
  const rows = data.baseline.ok.map((change) => ({ cells: [change.variant, "Runs ok", change.runs, { value: change.before, html: change.before }, { value: change.now, html: change.now }, null, "–", verdict(change.verdict)] }));
  for (const change of data.baseline.changes) {
    const metric = data.metrics[change.metric];
    const interval = change.interval ? `${shortNumber(change.interval[0])} to ${shortNumber(change.interval[1])}` : "–";
    rows.push({ cells: [change.variant, withUnit(metric), change.recordings, change.before, change.now, change.percent, interval, verdict(change.verdict)] });
  }
  const order = ["regressed", "improved", "no change"];
  rows.sort((a, b) => order.indexOf(a.cells[7].value) - order.indexOf(b.cells[7].value));
  drawTable("baseline", "Against the baseline", [{ head: "Pipeline", name: true }, { head: "Metric" }, { head: "Recordings (runs)", numeric: true, count: true }, { head: "Before", numeric: true },
    { head: "Now", numeric: true }, { head: "Change [%]", numeric: true }, { head: "95 % interval [%]" }, { head: "Verdict" }], rows, { atFirst: RUNS_AT_FIRST });
}
