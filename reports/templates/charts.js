// Charts of report.json: hover reads every chart of the page at one moment, dragging zooms into all
// that share the axis, a click takes the whole page to that moment.
"use strict";
(() => {
  const { element, button } = traverse;
  const linked = [];  // those over time or distance
  let overDistance = false;
  let busy = false;

  /** Poses of the chart's values and their places on the axis. */
  const posesOf = (chart) => chart.pose ?? traverse.report.poses.time_s.map((_, i) => i);
  const axisOf = (chart, poses) => chart.x ??
    poses.map((pose) => traverse.report.poses[overDistance ? "distance_m" : "time_s"][pose]);

  /** Values as they are drawn: of stacked series the sums. */
  const columnsOf = (chart) => {
    if (!chart.stacked) return chart.series.map((series) => series.values);
    const sums = [];
    chart.series.forEach((series, k) => {
      sums.push(series.values.map((value, i) => value + (k > 0 ? sums[k - 1][i] : 0)));
    });
    return sums;
  };

  /** Whether the values have a band to both sides: all series then, and no level. */
  const hasBand = (chart) => chart.series.some((series) => series.band);

  const rowsOf = (chart, poses) => {
    const columns = columnsOf(chart);
    const level = chart.level ? [chart.level.value] : [];
    const cell = (column, k, i) => {
      const value = chart.log && !(column[i] > 0) ? null : column[i];
      const band = chart.series[k].band?.[i];
      return hasBand(chart) ? [value - band, value, value + band] : value;
    };
    return axisOf(chart, poses).map((x, i) =>
      [x, ...columns.map((column, k) => cell(column, k, i)), ...level]);
  };

  const readout = (view, row) => {
    const { chart, poses, axis } = view;
    if (row === null) {
      view.shown.tell(null);
      return;
    }
    view.shown.tell(chart.x ? `${chart.x_name} ${traverse.figure(axis[row])}` : traverse.describe(poses[row]),
      chart.series.map((series, k) => ({ colour: traverse.colour(k), name: series.name, value: series.values[row], unit: chart.unit })));
    view.shown.element.dataset.row = row;
  };

  /** The last row at or before that pose. */
  const rowOfPose = (view, pose) => {
    const row = view.rowOfPose.get(pose);
    if (row !== undefined) return row;
    let nearest = null;
    view.poses.forEach((other, i) => { if (other <= pose) nearest = i; });
    return nearest;
  };

  const select = (view, row) => {
    if (row === null) view.shown.graph.clearSelection();
    else view.shown.graph.setSelection(row);
    readout(view, row);
  };

  const hover = (source, row) => {
    const pose = source.poses[row];
    for (const view of linked) select(view, view === source ? row : rowOfPose(view, pose));
  };

  const zoom = (source, range) => {
    if (busy) return;
    busy = true;
    for (const view of linked) if (view !== source) view.shown.graph.updateOptions({ dateWindow: range });
    busy = false;
  };

  /** The line at the moment that the page looks at; an element, so that moving it draws nothing. */
  const markMoment = (view) => {
    const { graph } = view.shown;
    const row = rowOfPose(view, traverse.pose);
    const x = row === null || !graph ? NaN : graph.toDomXCoord(view.axis[row]);
    const area = graph?.getArea();
    view.mark.hidden = !(area && x >= area.x - 1 && x <= area.x + area.w + 1);
    if (!view.mark.hidden) view.mark.style.left = `${x}px`;
  };

  /** The whole run, for all charts over time or distance. */
  const wholeRun = () => {
    const axis = traverse.report.poses[overDistance ? "distance_m" : "time_s"];
    return [axis[0], axis[axis.length - 1] || 1];
  };

  const makeView = (chart, place) => {
    const view = { chart, poses: posesOf(chart), mark: element("div", "moment-mark") };
    view.axis = axisOf(chart, view.poses);
    view.rowOfPose = new Map(view.poses.map((pose, row) => [pose, row]));
    const figure = element("figure", "chart");
    figure.id = `chart-${chart.id}`;
    view.shown = traverse.chart(figure, chart.unit ? `${chart.title} [${chart.unit}]` : chart.title, chart.x_name ?? "time [s]");
    if (!chart.x) view.shown.plot.append(view.mark);
    place.append(figure);
    const names = chart.series.map((series) => series.name || "value");
    const options = {
      labels: [chart.x ? chart.x_name : "x", ...names, ...(chart.level ? [chart.level.name] : [])],
      colors: [...names.map((_, k) => traverse.colour(k)), ...(chart.level ? ["#8a8f98"] : [])],
      logscale: chart.log, fillGraph: chart.stacked, drawPoints: chart.points,
      includeZero: !chart.log && chart.series.every((s) => s.values.every((v) => v === null || v >= 0)),
      connectSeparatedPoints: false, customBars: hasBand(chart), fillAlpha: 0.15,
      highlightCallback: (event, x, points, row) => (chart.x ? readout(view, row) : hover(view, row)),
      unhighlightCallback: () => (chart.x ? readout(view, null) : hover(view, rowOfPose(view, traverse.pose) ?? 0)),
      zoomCallback: (least, most) => { if (!chart.x) zoom(view, [least, most]); },
      clickCallback: () => {
        const row = view.shown.graph.getSelection();
        if (row >= 0 && view.poses[row] !== undefined && chart.id.indexOf("kitti") !== 0) {
          traverse.look(view.poses[row], chart.id);
        }
      },
      drawCallback: () => { if (!chart.x) markMoment(view); },
    };
    if (chart.level) options.series = { [chart.level.name]: { strokePattern: [6, 4], strokeWidth: 1, drawPoints: false, fillGraph: false } };
    if (chart.x) options.xRangePad = 6;
    else options.dateWindow = wholeRun();
    view.shown.draw(rowsOf(chart, view.poses), options);
    if (!chart.x) {
      linked.push(view);
      // A double click shows the whole run again in every chart.
      view.shown.canvas.addEventListener("dblclick", () => zoom(null, wholeRun()));
    }
  };

  const setAxis = (distance) => {
    overDistance = distance;
    for (const view of linked) {
      view.axis = axisOf(view.chart, view.poses);
      view.shown.below.textContent = distance ? "distance [m]" : "time [s]";
      view.shown.graph.updateOptions({ file: rowsOf(view.chart, view.poses), dateWindow: wholeRun() });
    }
    for (const choice of document.querySelectorAll(".axis-choice button")) {
      choice.setAttribute("aria-pressed", String((choice.dataset.axis === "distance") === distance));
    }
  };

  const axisChoice = () => {
    const bar = element("div", "axis-choice");
    bar.append(element("span", "how", "Over "));
    for (const axis of ["time", "distance"]) {
      const choice = button(axis === "time" ? "time [s]" : "distance [m]", () => setAxis(axis === "distance"));
      choice.dataset.axis = axis;
      choice.setAttribute("aria-pressed", String(axis === "time"));
      bar.append(choice);
    }
    bar.append(element("span", "how", "Drag to zoom, double click for all, click a moment to go there."));
    return bar;
  };

  for (const place of document.querySelectorAll("[data-charts]")) {
    const charts = traverse.report.charts.filter((chart) => chart.section === place.dataset.charts);
    if (charts.length === 0) continue;
    place.hidden = false;
    if (charts.some((chart) => !chart.x)) place.append(axisChoice());
    for (const chart of charts) makeView(chart, place);
  }
  document.documentElement.classList.add("has-charts");

  const follow = () => {
    for (const view of linked) {
      select(view, rowOfPose(view, traverse.pose));
      markMoment(view);
    }
  };
  traverse.follow(follow);
  follow();
})();
