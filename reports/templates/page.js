// What the scripts of every page share: its numbers (traverse.report), how numbers and cells are
// written, and elements of the page.
"use strict";
const traverse = (() => {
  const kThinSpace = "\u2009";

  // JavaScript rounds ties up, C++ to even; all digits tell which is one: 12.25 is 12.2 in both.
  const rounded = (write, digits) => {
    const [exact, exponent] = write(digits + 40).split("e");
    const end = exact.indexOf(".") + 1 + digits;
    const kept = exact.slice(0, end);
    const downwards = /^50*$/.test(exact.slice(end)) && "02468".includes(kept.at(-1));
    return downwards ? kept + (exponent === undefined ? "" : `e${exponent}`) : write(digits);
  };

  /** As files/number_text.cpp has it: three or four digits, a true minus sign. */
  const short = (value) => {
    if (value === null || value === undefined || !Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    if (size === 0) return "0";
    const text = size >= 1e6 || size < 1e-4
      ? rounded((digits) => size.toExponential(digits), 2).replace(/e([+-])(\d)$/, "e$10$2")
      : rounded((digits) => size.toFixed(digits), size >= 100 ? 1 : Math.max(0, 2 - Math.floor(Math.log10(size))));
    return (value < 0 ? "−" : "") + text;
  };

  /** A whole number, with thin spaces between thousands from five digits on. */
  const count = (value) => {
    const digits = String(Math.abs(value));
    const text = digits.length > 4 ? digits.replace(/\B(?=(\d{3})+$)/g, kThinSpace) : digits;
    return (value < 0 ? "−" : "") + text;
  };

  /** Whichever of both fits: of values that may be counts. */
  const figure = (value) => (Number.isInteger(value) && Math.abs(value) < 1e6 ? count(value) : short(value));

  const escapeHtml = (text) =>
    String(text).replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);

  /** A cell of a CSV file, as libs/files/src/csv.cpp writes it. */
  const csvCell = (value) => {
    const text = value === null || value === undefined ? "" : String(value);
    const number = /^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$|^[+-]?(inf|infinity|nan)$/i.test(text);
    const formula = /^[=+\-@\t\r\n]/.test(text) && !number;
    if (!formula && !/[",\r\n]/.test(text)) return text;
    return `"${formula ? "'" : ""}${text.replace(/"/g, '""')}"`;
  };

  /** A text in LaTeX, as libs/files/src/latex.cpp writes it. */
  const kLatex = { "\\": "\\textbackslash{}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}",
    "<": "\\textless{}", ">": "\\textgreater{}", "\n": " ", "\r": " " };
  const latexText = (text) => text.replace(/[&%$#_{}\\~^<>\n\r]/g, (c) => kLatex[c] ?? `\\${c}`);

  const element = (name, className, text) => {
    const result = document.createElement(name);
    if (className) result.className = className;
    if (text) result.textContent = text;
    return result;
  };

  const button = (text, action) => {
    const result = element("button", "", text);
    result.type = "button";
    result.addEventListener("click", action);
    return result;
  };

  for (const head of document.querySelectorAll("section[id] > h2, h3[id]")) {
    const link = element("a", "anchor", "#");
    link.href = `#${head.id || head.parentElement.id}`;
    link.setAttribute("aria-label", "link to this section");
    head.append(" ", link);
  }

  return {
    report: JSON.parse(document.getElementById("report-data").textContent),
    short, count, figure, escapeHtml, csvCell, latexText, element, button,
    dark: window.matchMedia("(prefers-color-scheme: dark)"),
    /** Colours of series, in their order; the same as those of pictures. */
    colours: ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7a7a7a", "#8c6d31"],
    colour(k) { return this.colours[k % this.colours.length]; },
  };
})();
