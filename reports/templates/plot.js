// A chart as every page shows it: its name, what it tells where the pointer is, and the plot, which
// dygraphs draws in the page's colours.
"use strict";
(() => {
  const { element } = traverse;
  const graphs = [];
  const ink = () => (traverse.dark.matches ? { axisLineColor: "#5b6069", gridLineColor: "#2c3038" }
    : { axisLineColor: "#a2a8b3", gridLineColor: "#e6e8ec" });

  // The library's own labels round small numbers until neighbours look alike.
  const axisLabel = (value) => String(Number(value.toPrecision(4))).replace("-", "−");

  /**
   * Fills `figure`: a chart of that title with the name of its axis below; its plot is empty. `label`
   * says what it shows to those who cannot see it.
   */
  traverse.chart = (figure, title, below, label = title) => {
    const chart = {
      element: figure, readout: element("div", "readout"), canvas: element("div", "plot"),
      plot: element("div", "plot-with-mark"), below: element("div", "axis-name", below), graph: null,
      /** Draws the rows by dygraphs with these options over the page's own. */
      draw(rows, options) {
        this.graph = new Dygraph(this.canvas, rows, {
          legend: "never", strokeWidth: 1.5, pointSize: 2.5, highlightCircleSize: 4, animatedZooms: false,
          axisLabelFontSize: 12, rightGap: 12, ...ink(), ...options,
          axes: { x: { axisLabelFormatter: axisLabel, ...options.axes?.x }, y: { axisLabelFormatter: axisLabel, ...options.axes?.y } },
        });
        graphs.push(this.graph);
        return this.graph;
      },
      /** Tells a place and values there: {colour, name, value, unit}; nothing for null. */
      tell(where, values) {
        this.readout.replaceChildren();
        if (where === null) return;
        this.readout.append(element("span", "where", where));
        for (const { colour, name, value, unit } of values) {
          const item = element("span", "value");
          const swatch = element("i");
          swatch.style.background = colour;
          const number = element("b", "", traverse.figure(value));
          number.dataset.value = String(value);
          item.append(swatch, ` ${name} `, number, unit ? ` ${unit}` : "");
          this.readout.append(item);
        }
      },
    };
    const head = element("div", "chart-head");
    head.append(element("h4", "", title));
    chart.canvas.setAttribute("role", "img");
    chart.canvas.setAttribute("aria-label", label);
    chart.plot.append(chart.canvas);
    figure.replaceChildren(head, chart.readout, chart.plot, chart.below);
    return chart;
  };

  /** Names with their colours, above a chart. */
  traverse.legend = (names) => {
    const legend = element("div", "legend");
    names.forEach((name, k) => {
      const entry = element("span");
      const swatch = element("i");
      swatch.style.background = traverse.colour(k);
      entry.append(swatch, name);
      legend.append(entry);
    });
    return legend;
  };

  /** Forgets the graphs whose places are no longer in the page. */
  traverse.forgetGraphs = () => {
    for (let k = graphs.length - 1; k >= 0; --k) {
      if (!document.body.contains(graphs[k].graphDiv)) graphs.splice(k, 1)[0].destroy();
    }
  };

  traverse.dark.addEventListener("change", () => {
    for (const graph of graphs) graph.updateOptions(ink());
  });
})();
