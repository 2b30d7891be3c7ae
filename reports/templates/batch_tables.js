// Tables of the batch page: numbers as the run report writes them, sorting, filter, CSV.
"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const RUNS_AT_FIRST = 500;

function escapeHtml(text) {
  return String(text).replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
}

// Three or four significant digits, a true minus sign, a dash for what is not there.
function shortNumber(value) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const magnitude = Math.abs(value);
  let text = "0";
  if (magnitude >= 1e6 || (magnitude > 0 && magnitude < 1e-4)) text = value.toExponential(2);
  else if (magnitude >= 100) text = value.toFixed(1);
  else if (magnitude > 0) text = value.toFixed(Math.max(0, 2 - Math.floor(Math.log10(magnitude))));
  return text.replace("-", "−");
}

function withUnit(metric) {
  return metric.unit ? `${metric.title} [${metric.unit}]` : metric.title;
}

function mean(values) {
  const known = values.filter((value) => value !== null);
  return known.length ? known.reduce((a, b) => a + b, 0) / known.length : null;
}

// A table from columns {head, name?, numeric?, count?, lower?} and rows {cells, summary?} of cells: a
// value, or {value, html, className}. Options: best (mark the best of each column), atFirst (rows
// shown before "show all"). Columns of figures that no row has are left out and named below.
function drawTable(place, allColumns, allRows, options = {}) {
  const held = (cell) => (cell !== null && typeof cell === "object" ? cell.value : cell);
  const kept = allColumns.map((column, k) => k).filter((k) => !allColumns[k].numeric || allRows.length === 0
    || allRows.some((row) => held(row.cells[k]) !== null));
  const columns = kept.map((k) => allColumns[k]);
  const rows = allRows.map((row) => ({ ...row, cells: kept.map((k) => row.cells[k]) }));
  const empty = allColumns.filter((column) => !columns.includes(column)).map((column) => column.head);
  const state = { sort: -1, ascending: true, filter: "", all: false };
  const value = held;
  const best = columns.map((column, k) => {
    if (!options.best || !column.lower || rows.length < 2) return undefined;
    const known = rows.filter((row) => !row.summary).map((row) => value(row.cells[k])).filter((v) => Number.isFinite(v));
    return known.length > 1 ? Math.min(...known) : undefined;
  });

  function cellHtml(cell, k, row) {
    const column = columns[k];
    const figure = value(cell);
    const classes = [];
    if (column.numeric) classes.push("n");
    if (column.name) classes.push("name");
    if (cell !== null && typeof cell === "object" && cell.className) classes.push(cell.className);
    if (best[k] !== undefined && figure === best[k] && !row.summary) classes.push("best");
    const full = column.numeric && Number.isFinite(figure) ? ` title="${figure}"` : "";
    const html = cell !== null && typeof cell === "object" && cell.html !== undefined ? cell.html
      : column.count ? escapeHtml(figure ?? "–")
      : column.numeric ? shortNumber(figure) : escapeHtml(figure ?? "–");
    return `<td${classes.length ? ` class="${classes.join(" ")}"` : ""}${full}>${html}</td>`;
  }

  function shown() {
    const words = state.filter.toLowerCase().split(/\s+/).filter(Boolean);
    const kept = rows.filter((row) => {
      if (!words.length) return true;
      const text = row.cells.map((cell) => value(cell)).join(" ").toLowerCase();
      return words.every((word) => text.includes(word));
    });
    if (state.sort < 0) return kept;
    const k = state.sort;
    const sign = state.ascending ? 1 : -1;
    const missing = (v) => v === null || v === undefined || (typeof v === "number" && !Number.isFinite(v));
    return [...kept].sort((a, b) => {
      if (a.summary || b.summary) return (a.summary ? 1 : 0) - (b.summary ? 1 : 0);
      const x = value(a.cells[k]);
      const y = value(b.cells[k]);
      if (missing(x) || missing(y)) return (missing(x) ? 1 : 0) - (missing(y) ? 1 : 0);
      return sign * (typeof x === "number" && typeof y === "number" ? x - y : String(x).localeCompare(String(y), undefined, { numeric: true }));
    });
  }

  function draw() {
    const list = shown();
    const visible = state.all || !options.atFirst ? list : list.slice(0, options.atFirst);
    body.innerHTML = visible.map((row) =>
      `<tr${row.summary ? ' class="summary"' : ""}>${row.cells.map((cell, k) => cellHtml(cell, k, row)).join("")}</tr>`).join("");
    count.textContent = visible.length < list.length ? `${visible.length} of ${list.length} rows`
      : list.length < rows.length ? `${list.length} of ${rows.length} rows` : `${rows.length} rows`;
    more.hidden = visible.length === list.length;
    [...head.children].forEach((cell, k) => {
      if (state.sort === k) cell.setAttribute("aria-sort", state.ascending ? "ascending" : "descending");
      else cell.removeAttribute("aria-sort");
    });
  }

  place.innerHTML = `<div class="tools"><input type="search" placeholder="Filter" aria-label="Filter the rows"><button type="button" class="csv">CSV</button><button type="button" class="more">Show all</button><span class="count"></span></div>
    <div class="scroll"><table class="data"><thead><tr>${columns.map((column) =>
      `<th scope="col" class="${column.numeric ? "n " : ""}${column.name ? "name" : ""}"><button type="button">${escapeHtml(column.head)}</button></th>`).join("")}</tr></thead><tbody></tbody></table></div>${empty.length ? `<p class="how">Not defined for any of these runs: ${escapeHtml(empty.join(", "))}.</p>` : ""}`;
  const head = place.querySelector("thead tr");
  const body = place.querySelector("tbody");
  const count = place.querySelector(".count");
  const more = place.querySelector(".more");
  const search = place.querySelector("input");
  search.hidden = rows.length <= 10;
  search.addEventListener("input", () => { state.filter = search.value; draw(); });
  more.addEventListener("click", () => { state.all = true; draw(); });
  place.querySelector(".csv").addEventListener("click", () => {
    const lines = [columns.map((column) => traverseCsvCell(column.head)), ...shown().map((row) => row.cells.map((cell) => traverseCsvCell(value(cell))))];
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([lines.map((line) => line.join(",")).join("\n") + "\n"], { type: "text/csv" }));
    link.download = `${place.dataset.table}.csv`;
    link.click();
    URL.revokeObjectURL(link.href);
  });
  [...head.children].forEach((cell, k) => cell.addEventListener("click", () => {
    state.ascending = state.sort === k ? !state.ascending : true;
    state.sort = k;
    draw();
  }));
  draw();
}

const place = (name) => document.querySelector(`[data-table="${name}"]`);

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
  drawTable(place("leaderboard"), [{ head: "#", numeric: true, count: true }, { head: "Pipeline", name: true }, { head: "Runs ok", numeric: true },
    ...(data.budgets.length ? [{ head: "Over budget", numeric: true, count: true }] : []), ...columns], rows, { best: true, atFirst: RUNS_AT_FIRST });
}

// Runs that are ok of a recording and a variant; both null for all.
const okByPlace = new Map();
for (const run of data.runs) {
  if (run.outcome !== "ok") continue;
  const key = `${run.recording} ${run.variant}`;
  if (!okByPlace.has(key)) okByPlace.set(key, []);
  okByPlace.get(key).push(run);
}
function okRuns(recording, variant) {
  if (recording === null) return [...okByPlace.values()].flat();
  return okByPlace.get(`${recording} ${variant}`) ?? [];
}
const meansOf = (runs) => data.metrics.map((metric, k) => mean(runs.map((run) => run.values[k])));

function drawMatrix(metric) {
  const rows = data.variants.map((variant, v) => ({
    cells: [variant.name, ...data.recordings.map((recording, r) => mean(okRuns(r, v).map((run) => run.values[metric])))],
  }));
  drawTable(place("matrix"), [{ head: "Pipeline", name: true },
    ...data.recordings.map((name) => ({ head: name, numeric: true, lower: data.metrics[metric].lower }))], rows, { best: true, atFirst: RUNS_AT_FIRST });
}

function drawRecording(recording) {
  const columns = metricColumns(false);
  const rows = data.variants.map((variant, v) => {
    const means = meansOf(okRuns(recording, v));
    return { cells: [variant.name, ...columns.map((column) => column.of(means))] };
  });
  drawTable(place("recording"), [{ head: "Pipeline", name: true }, ...columns], rows, { best: true, atFirst: RUNS_AT_FIRST });
}

function drawPipeline(variant) {
  const columns = metricColumns(false);
  const rows = data.recordings.map((name, r) => {
    const means = meansOf(okRuns(r, variant));
    return { cells: [name, ...columns.map((column) => column.of(means))] };
  });
  const summary = data.variants[variant];
  rows.push({ summary: true, cells: ["Mean of recordings", ...data.metrics.map((metric, k) => summary.means[k])] });
  if (summary.kitti) {
    rows.push({ summary: true, cells: [`All ${summary.kitti.segments} segments (KITTI benchmark)`, ...data.metrics.map((metric) =>
      metric.key === "kitti_translation_percent" ? summary.kitti.translation.all_segments
        : metric.key === "kitti_rotation_deg_per_m" ? summary.kitti.rotation.all_segments : null)] });
  }
  drawTable(place("pipeline"), [{ head: "Recording", name: true }, ...columns], rows);
}

function drawRuns() {
  const rows = data.runs.map((run) => ({
    cells: [data.recordings[run.recording], data.variants[run.variant].name, run.repeat,
      { value: run.outcome ?? "not made", html: `<span class="outcome ${run.outcome === "ok" ? "ok" : "bad"}">${escapeHtml(run.outcome ?? "not made")}</span>` },
      ...run.values.map((value, k) => ({ value, className: data.budgets.some((budget) => budget.metric === data.metrics[k].key && value !== null && value > budget.most) ? "over" : "" })),
      { value: run.folder ?? "", html: run.folder === null ? "–"
        : `<a href="${escapeHtml(run.folder)}/${run.report ? "report.html" : "run.json"}">${run.report ? "report" : "run.json"}</a> · <a href="${escapeHtml(run.folder)}/log.txt">log</a>` }],
  }));
  drawTable(place("runs"), [{ head: "Recording", name: true }, { head: "Pipeline", name: true }, { head: "Repeat", numeric: true, count: true }, { head: "Outcome" },
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
  drawTable(place("baseline"), [{ head: "Pipeline", name: true }, { head: "Metric" }, { head: "Recordings (runs)", numeric: true, count: true }, { head: "Before", numeric: true },
    { head: "Now", numeric: true }, { head: "Change [%]", numeric: true }, { head: "95 % interval [%]" }, { head: "Verdict" }], rows, { atFirst: RUNS_AT_FIRST });
}
