// Tables: sorted by a click on a column's head, filtered, copied as CSV or LaTeX. Those of the page
// are whole without; those that batch_tables.js describes are made here.
"use strict";
(() => {
  const { button, element, escapeHtml } = traverse;
  const kMany = 10;  // more rows than these can be filtered

  const missing = (value) => value === null || value === undefined || (typeof value === "number" && !Number.isFinite(value));
  const compare = (a, b) => (typeof a === "number" && typeof b === "number" ? a - b
    : String(a).localeCompare(String(b), undefined, { numeric: true }));

  const save = (name, text) => {
    const link = element("a");
    link.href = URL.createObjectURL(new Blob([text], { type: "text/plain" }));
    link.download = name;
    link.click();
    URL.revokeObjectURL(link.href);
  };

  // As page/table_files.cpp writes them.
  const csv = (columns, rows) => [columns, ...rows.map((row) => row.values)]
    .map((cells) => cells.map(traverse.csvCell).join(",") + "\r\n").join("");
  const latexCell = (cell) => {
    const text = cell.classList.contains("n")
      ? cell.textContent.replace(/\u2009/g, "").replace(/−/g, "$-$").replace(/–/g, "--").replace(/±/g, "$\\pm$")
      : traverse.latexText(cell.textContent);
    return cell.classList.contains("best") ? `\\textbf{${text}}` : text;
  };
  const latex = (title, columns, heads, rows) =>
    `% ${title}; needs \\usepackage{booktabs}\n` +
    `\\begin{tabular}{${heads.map((head) => (head.classList.contains("n") ? "r" : "l")).join("")}}\n\\toprule\n` +
    `${columns.map(traverse.latexText).join(" & ")} \\\\\n\\midrule\n` +
    `${rows.map((row) => `${[...row.element().cells].map(latexCell).join(" & ")} \\\\\n`).join("")}` +
    "\\bottomrule\n\\end{tabular}\n";

  /**
   * Makes a table one that is used. `place` holds the `table` with its head; `rows` are {values,
   * element: () => its tr, last: below all others}. Options: sortable (from the first row on), atFirst
   * (rows shown before all are asked for).
   */
  const use = (place, table, { name, title, columns, rows }, options = {}) => {
    const body = table.tBodies[0];
    const heads = [...table.tHead.rows[0].cells];
    const state = { sort: -1, ascending: true, words: [], all: !options.atFirst || rows.length <= options.atFirst };

    const chosen = () => {
      const kept = state.words.length === 0 ? rows : rows.filter((row) => {
        const text = row.values.join(" ").toLowerCase();
        return state.words.every((word) => text.includes(word));
      });
      if (state.sort < 0) return kept;
      return [...kept].sort((a, b) => {
        if (a.last || b.last) return (a.last ? 1 : 0) - (b.last ? 1 : 0);
        const x = a.values[state.sort];
        const y = b.values[state.sort];
        if (missing(x) || missing(y)) return (missing(x) ? 1 : 0) - (missing(y) ? 1 : 0);
        return (state.ascending ? 1 : -1) * compare(x, y);
      });
    };

    const told = element("span", "count");
    const more = button("Show all", () => { state.all = true; draw(); });
    const draw = () => {
      const list = chosen();
      const shown = state.all ? list : list.slice(0, options.atFirst);
      const lines = document.createDocumentFragment();
      for (const row of shown) lines.append(row.element());
      body.replaceChildren(lines);
      told.textContent = shown.length < list.length ? `${shown.length} of ${list.length} rows`
        : list.length < rows.length ? `${list.length} of ${rows.length} rows`
        : rows.length > kMany ? `${rows.length} rows` : "";
      more.hidden = shown.length === list.length;
      heads.forEach((head, k) => {
        if (state.sort === k) head.setAttribute("aria-sort", state.ascending ? "ascending" : "descending");
        else head.removeAttribute("aria-sort");
      });
    };

    if (options.sortable || rows.length > kMany) {
      heads.forEach((head, k) => {
        const sorter = button("", () => {
          state.ascending = state.sort === k ? !state.ascending : true;
          state.sort = k;
          draw();
        });
        sorter.append(...head.childNodes);
        head.append(sorter);
      });
    }
    if (rows.length > kMany) {
      const filter = element("input");
      filter.type = "search";
      filter.placeholder = "Filter";
      filter.setAttribute("aria-label", "Filter the rows");
      filter.addEventListener("input", () => {
        state.words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
        draw();
      });
      const tools = element("div", "tools");
      tools.append(filter);
      place.prepend(tools);
    }
    const bar = element("div", "exports");
    bar.append(button("CSV", () => save(`${name}.csv`, csv(columns, chosen()))),
      button("LaTeX", () => save(`${name}.tex`, latex(title, columns, heads, chosen()))), more, told);
    place.append(bar);
    draw();
  };

  // All digits of a number stand in its title.
  const valueOf = (cell) => (cell.title === "" ? cell.textContent : Number(cell.title));

  for (const table of document.querySelectorAll("table[data-table]")) {
    const name = table.dataset.table;
    const content = traverse.report.tables?.[name];
    const elements = [...table.tBodies[0].rows];
    const rows = elements.map((row, k) => ({
      values: content ? content.rows[k] : [...row.cells].map(valueOf), element: () => row,
    }));
    const columns = content ? content.columns : [...table.tHead.rows[0].cells].map((cell) => cell.textContent);
    use(table.closest(".table"), table, { name, title: table.caption.textContent, columns, rows });
  }

  /**
   * Makes a table in `place` from columns {head, name (a text to be read), numeric, count, lower (is
   * better)} and rows {cells, last} of cells: a value, or {value, html, className}. Options as above,
   * and best: mark the best of each column. Columns of figures that no row has are left out and named
   * below.
   */
  traverse.drawTable = (place, title, allColumns, allRows, options = {}) => {
    const held = (cell) => (cell !== null && typeof cell === "object" ? cell.value : cell);
    const kept = allColumns.map((column, k) => k).filter((k) => !allColumns[k].numeric || allRows.length === 0
      || allRows.some((row) => !missing(held(row.cells[k]))));
    const columns = kept.map((k) => allColumns[k]);
    const left = allColumns.filter((column) => !columns.includes(column)).map((column) => column.head);
    const rows = allRows.map((row) => ({ last: row.last, cells: kept.map((k) => row.cells[k]) }));
    const best = columns.map((column, k) => {
      if (!options.best || !column.lower) return undefined;
      const known = rows.filter((row) => !row.last).map((row) => held(row.cells[k])).filter((value) => Number.isFinite(value));
      return known.length > 1 ? Math.min(...known) : undefined;
    });

    const cellHtml = (cell, k, last) => {
      const column = columns[k];
      const value = held(cell);
      const classes = [];
      if (column.numeric) classes.push("n");
      if (column.name) classes.push("name");
      if (cell !== null && typeof cell === "object" && cell.className) classes.push(cell.className);
      if (best[k] !== undefined && value === best[k] && !last) classes.push("best");
      const full = column.numeric && Number.isFinite(value) ? ` title="${value}"` : "";
      const html = cell !== null && typeof cell === "object" && cell.html !== undefined ? cell.html
        : !column.numeric || missing(value) ? escapeHtml(value ?? "–")
        : column.count ? traverse.count(value) : traverse.short(value);
      return `<td${classes.length ? ` class="${classes.join(" ")}"` : ""}${full}>${html}</td>`;
    };
    const table = element("table", "data");
    table.innerHTML = `<caption>${escapeHtml(title)}</caption><thead><tr>${columns.map((column) =>
      `<th scope="col" class="${column.numeric ? "n " : ""}${column.name ? "name" : ""}">${escapeHtml(column.head)}</th>`).join("")}</tr></thead><tbody></tbody>`;
    const scroll = element("div", "scroll");
    scroll.append(table);
    place.replaceChildren(scroll);
    use(place, table, {
      name: place.dataset.content, title, columns: columns.map((column) => column.head),
      rows: rows.map(({ cells, last }) => {
        let made = null;
        return {
          last, values: cells.map(held),
          element: () => {
            if (made === null) {
              made = element("tr", last ? "summary" : "");
              made.innerHTML = cells.map((cell, k) => cellHtml(cell, k, last)).join("");
            }
            return made;
          },
        };
      }),
    }, { sortable: true, atFirst: options.atFirst });
    if (left.length > 0) place.append(element("p", "how", `Not defined for any of these runs: ${left.join(", ")}.`));
  };
})();
