// Charts of the batch page, drawn as SVG in the page's own colours, and the choices above them.
const SERIES = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"];
const MOST_BOXES = 60;

// Round ticks: 1, 2 or 5 times a power of ten.
function ticksOf(low, high) {
  if (!(high > low)) return [low];
  const raw = (high - low) / 5;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= raw * 0.999);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) ticks.push(Number((i * step).toPrecision(12)));
  return ticks;
}

function rangeOf(values) {
  let low = Math.min(...values);
  let high = Math.max(...values);
  const margin = high > low ? 0.06 * (high - low) : Math.abs(high) * 0.1 || 1;
  // What cannot be negative starts at zero unless that would hide the differences.
  low = low >= 0 && low < 0.5 * high ? 0 : low - margin;
  high += margin;
  return [low, high];
}

// An axis of values: linear, or logarithmic where all values are above zero.
function axisOf(values, wanted) {
  if (wanted !== "log" || Math.min(...values) <= 0) {
    const [low, high] = rangeOf(values);
    return { share: (value) => (value - low) / (high - low), ticks: ticksOf(low, high) };
  }
  const low = Math.log10(Math.min(...values) / 1.2);
  const high = Math.log10(Math.max(...values) * 1.2);
  const factors = high - low < 3 ? [1, 2, 5] : [1];
  const ticks = [];
  for (let power = Math.floor(low); power <= high; ++power) ticks.push(...factors.map((factor) => factor * 10 ** power));
  return { share: (value) => (Math.log10(value) - low) / (high - low), ticks: ticks.filter((tick) => Math.log10(tick) >= low && Math.log10(tick) <= high) };
}

function quantile(sorted, share) {
  const place = share * (sorted.length - 1);
  const below = Math.floor(place);
  return sorted[below] + (place - below) * ((sorted[below + 1] ?? sorted[below]) - sorted[below]);
}

const legendHtml = (names) => `<div class="legend">${names.map((name, i) => `<span><i style="background:${SERIES[i % SERIES.length]}"></i>${escapeHtml(name)}</span>`).join("")}</div>`;

// Grid lines and numbers of the axis on the left; `y` takes a value to pixels.
function leftAxis(ticks, y, left, right, title) {
  return ticks.map((tick) => `<line class="grid" x1="${left}" x2="${right}" y1="${y(tick)}" y2="${y(tick)}"/><text x="${left - 8}" y="${y(tick) + 4}" text-anchor="end">${shortAxis(tick)}</text>`).join("")
    + `<text class="muted" x="${left}" y="14">${escapeHtml(title)}</text>`;
}
const shortAxis = (value) => String(Number(value.toPrecision(6))).replace("-", "−");

function drawBoxes(metricIndex, boxesBy, groupsBy, scale) {
  const figure = document.getElementById("boxes");
  const metric = data.metrics[metricIndex];
  const boxNames = boxesBy === "pipeline" ? data.pipelines : data.variants.map((variant) => variant.name);
  const boxOf = (run) => (boxesBy === "pipeline" ? data.pipelines.indexOf(data.variants[run.variant].pipeline) : run.variant);
  const groupNames = groupsBy === "all" ? ["all recordings"] : data.recordings;
  const groups = groupNames.map(() => boxNames.map(() => []));
  for (const run of okRuns(null, null)) {
    const value = run.values[metricIndex];
    if (value !== null) groups[groupsBy === "all" ? 0 : run.recording][boxOf(run)].push(value);
  }
  const all = groups.flat(2);
  if (!all.length) {
    figure.innerHTML = `<p class="how">No run that is ok has ${escapeHtml(metric.title)}.</p>`;
    return;
  }
  const boxes = groupNames.length * boxNames.length;
  if (boxNames.length > MOST_BOXES) {
    figure.innerHTML = `<p class="how">${boxNames.length} boxes a group are too many to read: choose pipelines with all settings together, or see the sweep.</p>`;
    return;
  }
  const left = 64, top = 28, height = 300, bottom = 64;
  const width = Math.max(1040, left + boxes * 18 + groupNames.length * 24);
  const axis = axisOf(all, scale);
  const y = (value) => top + height * (1 - axis.share(value));
  const groupWidth = (width - left - 16) / groupNames.length;
  const slot = (groupWidth - 24) / boxNames.length;
  const boxWidth = Math.min(36, slot * 0.7);
  let svg = leftAxis(axis.ticks, y, left, width - 16, withUnit(metric));
  groups.forEach((group, g) => {
    const start = left + g * groupWidth + 12;
    group.forEach((values, b) => {
      if (!values.length) return;
      const sorted = [...values].sort((p, q) => p - q);
      const [q1, q2, q3] = [0.25, 0.5, 0.75].map((share) => quantile(sorted, share));
      const reach = 1.5 * (q3 - q1);
      const whiskers = [sorted.find((v) => v >= q1 - reach), [...sorted].reverse().find((v) => v <= q3 + reach)];
      const x = start + (b + 0.5) * slot;
      const colour = SERIES[b % SERIES.length];
      const title = `${boxNames[b]}, ${groupNames[g]}: median ${shortNumber(q2)}, quartiles ${shortNumber(q1)} and ${shortNumber(q3)}, ${values.length} runs`;
      svg += `<g stroke="${colour}" stroke-width="2" fill="${colour}"><title>${escapeHtml(title)}</title>`
        + `<line x1="${x}" x2="${x}" y1="${y(whiskers[0])}" y2="${y(q1)}"/><line x1="${x}" x2="${x}" y1="${y(q3)}" y2="${y(whiskers[1])}"/>`
        + `<rect x="${x - boxWidth / 2}" width="${boxWidth}" y="${y(q3)}" height="${Math.max(0, y(q1) - y(q3))}" fill-opacity="0.2"/>`
        + `<line x1="${x - boxWidth / 2}" x2="${x + boxWidth / 2}" y1="${y(q2)}" y2="${y(q2)}" stroke-width="3"/>`
        + sorted.map((value, i) => `<circle cx="${x + boxWidth * 0.22 * (((i * 7) % 5) / 2 - 1)}" cy="${y(value)}" r="2" stroke="none"/>`).join("") + "</g>";
    });
    const label = groupNames[g].length * 6.5 > groupWidth ? `${groupNames[g].slice(0, Math.max(3, Math.floor(groupWidth / 6.5) - 1))}…` : groupNames[g];
    svg += `<text x="${start + groupWidth / 2 - 12}" y="${top + height + 24}" text-anchor="middle"><title>${escapeHtml(groupNames[g])}</title>${escapeHtml(label)}</text>`;
  });
  figure.innerHTML = legendHtml(boxNames) + `<svg viewBox="0 0 ${width} ${top + height + bottom - 24}" style="min-width:${Math.min(width, width > 1040 ? width : 640)}px" role="img" aria-label="Box plots of ${escapeHtml(metric.title)}">${svg}</svg>`;
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
    perRecording.forEach((values, r) => lines.push({ values, p, name: `${pipeline}, ${data.recordings[r]}`, width: 1, opacity: 0.45 }));
    lines.push({ values: places.map((text, i) => mean(perRecording.map((values) => values[i]))), p, name: `${pipeline}, mean`, width: 3, opacity: 1 });
  });
  const all = lines.flatMap((line) => line.values).filter((value) => value !== null);
  if (!all.length) {
    figure.innerHTML = `<p class="how">No run that is ok has ${escapeHtml(metric.title)}.</p>`;
    return;
  }
  const width = 1040, left = 64, right = 24, top = 28, height = 300;
  const [low, high] = rangeOf(all);
  const y = (value) => top + height * (1 - (value - low) / (high - low));
  const numbers = places.map(Number);
  const span = numbers[numbers.length - 1] - numbers[0];
  const inner = width - left - right - 48;
  const x = (i) => left + 24 + inner * (places.length === 1 ? 0.5 : numeric ? (numbers[i] - numbers[0]) / span : i / (places.length - 1));
  let svg = leftAxis(ticksOf(low, high), y, left, width - right, withUnit(metric));
  let lastLabel = -Infinity;
  places.forEach((text, i) => {
    svg += `<line class="grid" x1="${x(i)}" x2="${x(i)}" y1="${top + height}" y2="${top + height + 5}"/>`;
    if (x(i) - lastLabel < 7 * text.length + 8) return;  // a label that would run into the last one
    lastLabel = x(i);
    svg += `<text x="${x(i)}" y="${top + height + 20}" text-anchor="middle">${escapeHtml(text)}</text>`;
  });
  svg += `<text class="muted" x="${width - right}" y="${top + height + 40}" text-anchor="end">${escapeHtml(key)}</text>`;
  for (const line of lines) {
    const points = line.values.map((value, i) => (value === null ? null : [x(i), y(value)])).filter(Boolean);
    const colour = SERIES[line.p % SERIES.length];
    svg += `<g opacity="${line.opacity}"><title>${escapeHtml(line.name)}</title><polyline points="${points.map((point) => point.join(",")).join(" ")}" fill="none" stroke="${colour}" stroke-width="${line.width}" stroke-linejoin="round"/>`
      + points.map(([px, py]) => `<circle cx="${px}" cy="${py}" r="${line.width > 1 ? 4 : 2}" fill="${colour}"/>`).join("") + "</g>";
  }
  figure.innerHTML = legendHtml(data.pipelines) + `<svg viewBox="0 0 ${width} ${top + height + 48}" style="min-width:640px" role="img" aria-label="${escapeHtml(metric.title)} over ${escapeHtml(key)}">${svg}</svg>`;
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
drawLeaderboard();
drawBaseline();
redraw();
drawRuns();
