// Tables: more than ten rows are sorted by a click on a column's head; each can be copied as CSV or
// LaTeX; a cell that names a frame takes the page there. The page is whole without.
"use strict";
(() => {
  const button = (text, action) => {
    const result = document.createElement("button");
    result.type = "button";
    result.textContent = text;
    result.addEventListener("click", action);
    return result;
  };

  const sortable = (table) => {
    const body = table.tBodies[0];
    if (body.rows.length <= 10) return;
    const value = (row, column) => {
      const cell = row.cells[column];
      const number = Number(cell.title || cell.textContent.replace(/\u2009/g, "").replace("\u2212", "-"));
      return Number.isNaN(number) ? cell.textContent : number;
    };
    const compare = (a, b) => (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b)));
    for (const head of table.tHead.rows[0].cells) {
      const sorter = document.createElement("button");
      sorter.type = "button";
      sorter.append(...head.childNodes);
      head.append(sorter);
      sorter.addEventListener("click", () => {
        const ascending = head.getAttribute("aria-sort") !== "ascending";
        for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
        head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
        const rows = [...body.rows].sort((a, b) => compare(value(a, head.cellIndex), value(b, head.cellIndex)));
        body.append(...(ascending ? rows : rows.reverse()));
      });
    }
  };

  // As exports.cpp writes them.
  const csv = (table) => [table.columns, ...table.rows].map((row) => row.map(traverseCsvCell).join(",") + "\r\n").join("");
  const kLatex = { "\\": "\\textbackslash{}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}",
    "<": "\\textless{}", ">": "\\textgreater{}", "\n": " ", "\r": " " };
  const latexText = (text) => text.replace(/[&%$#_{}\\~^<>\n\r]/g, (c) => kLatex[c] ?? `\\${c}`);
  // Numbers as the page shows them.
  const latexCell = (cell) => (cell.classList.contains("n")
    ? cell.textContent.replace(/\u2009/g, "").replace("−", "$-$").replace("–", "--")
    : latexText(cell.textContent));
  const latex = (table, element) => {
    const rows = [...element.tBodies[0].rows].map((row) => [...row.cells]);
    const columns = [...element.tHead.rows[0].cells].map((cell) => (cell.classList.contains("n") ? "r" : "l")).join("");
    return `% ${table.title}; needs \\usepackage{booktabs}\n\\begin{tabular}{${columns}}\n\\toprule\n` +
      `${table.columns.map(latexText).join(" & ")} \\\\\n\\midrule\n` +
      `${rows.map((row) => `${row.map(latexCell).join(" & ")} \\\\\n`).join("")}\\bottomrule\n\\end{tabular}\n`;
  };

  const save = (name, text) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type: "text/plain" }));
    link.download = name;
    link.click();
    URL.revokeObjectURL(link.href);
  };

  const exportable = (table) => {
    const id = table.dataset.table;
    const content = traverse.report.tables[id];
    if (!content) return;
    const bar = document.createElement("div");
    bar.className = "exports";
    bar.append(button("CSV", () => save(`${id}.csv`, csv(content))),
      button("LaTeX", () => save(`${id}.tex`, latex(content, table))));
    table.closest(".table").append(bar);
  };

  for (const table of document.querySelectorAll("table[data-table]")) {
    sortable(table);
    exportable(table);
  }
  for (const cell of document.querySelectorAll("td[data-pose]")) {
    const pose = Number(cell.dataset.pose);
    const text = cell.textContent;
    cell.replaceChildren(button(text, () => traverse.look(pose, "table")));
    cell.classList.add("moment");
  }
  for (const head of document.querySelectorAll("section[id] > h2, h3[id]")) {
    const link = document.createElement("a");
    link.className = "anchor";
    link.href = `#${head.id || head.parentElement.id}`;
    link.textContent = "#";
    link.setAttribute("aria-label", "link to this section");
    head.append(" ", link);
  }
  const asked = /^#pose=(\d+)$/.exec(window.location.hash);
  traverse.look(asked ? Number(asked[1]) : 0, "start");
})();
