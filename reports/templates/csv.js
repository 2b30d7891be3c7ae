// A cell of a CSV file, as libs/files/src/csv.cpp writes it: quoted as RFC 4180 says, and what a
// spreadsheet would compute is marked as text.
"use strict";
globalThis.traverseCsvCell = (value) => {
  const text = value === null || value === undefined ? "" : String(value);
  const number = /^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$|^[+-]?(inf|infinity|nan)$/i.test(text);
  const formula = /^[=+\-@\t\r\n]/.test(text) && !number;
  if (!formula && !/[",\r\n]/.test(text)) return text;
  return `"${formula ? "'" : ""}${text.replace(/"/g, '""')}"`;
};
