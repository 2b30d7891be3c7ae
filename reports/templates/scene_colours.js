// Numbers as colours: the scales of the 3-D view.
"use strict";
const sceneColours = (() => {
  /** A colour map as numbers; `share` from 0 to 1. */
  const colourMap = (name) => {
    const table = traverse.report.scene.colours[name].map((hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)));
    return (share) => table[Math.round(Math.min(Math.max(share, 0), 1) * (table.length - 1))];
  };
  const viridis = colourMap("viridis");
  const cividis = colourMap("cividis");

  /** Shares of the scale that ends at the 2nd and 98th percentile. */
  const scaled = (values) => {
    const finite = Float64Array.from(values.filter ? values.filter((v) => v !== null) : values).sort();
    const low = finite[Math.floor(0.02 * (finite.length - 1))];
    const high = finite[Math.ceil(0.98 * (finite.length - 1))];
    return { low, high, share: (v) => (high > low ? (v - low) / (high - low) : 0.5) };
  };

  /** Fills a colour attribute, `each` vertices a value; what is not known is grey. */
  const paint = (attribute, values, map, each) => {
    const scale = scaled(values);
    for (let i = 0; i < values.length; ++i) {
      const rgb = values[i] === null ? [128, 128, 128] : map(scale.share(values[i]));
      for (let k = 0; k < each; ++k) attribute.array.set(rgb, 3 * (each * i + k));
    }
    attribute.needsUpdate = true;
    return scale;
  };

  /** A scale in words. */
  const told = (what, unit, scale) => `${what}: ${traverse.figure(scale.low)} to ${traverse.figure(scale.high)} ${unit} (2nd to 98th percentile)`;

  return { viridis, cividis, paint, told };
})();
