"use strict";
// Columns sort by a click on their head: numbers by value, words by letter; a second click turns the order.
for (const table of document.querySelectorAll("main table")) {
  const body = table.tBodies[0];
  if (!body || body.rows.length < 3) continue;
  [...table.tHead.rows[0].cells].forEach((head, place) => {
    head.tabIndex = 0;
    head.classList.add("sorts");
    const sort = () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const key = (row) => row.cells[place].dataset.v ?? row.cells[place].textContent.trim();
      const compare = (a, b) => {
        const [x, y] = [key(a), key(b)];
        const [s, t] = [Number(x), Number(y)];
        const numbers = x !== "" && y !== "" && !Number.isNaN(s) && !Number.isNaN(t);
        return numbers ? s - t : x.localeCompare(y);
      };
      // Missing values are last in both directions.
      const lacks = (row) => row.cells[place].querySelector(".missing") !== null;
      const rows = [...body.rows].filter((row) => !lacks(row)).sort(compare);
      body.append(...(down ? rows.reverse() : rows), ...[...body.rows].filter(lacks));
    };
    head.addEventListener("click", sort);
    head.addEventListener("keydown", (event) => { if (event.key === "Enter") sort(); });
  });
}
// A click on an entry of a legend hides its series in that figure; a second click shows it again.
for (const svg of document.querySelectorAll("figure svg")) {
  const name = (group) => group.querySelector(":scope > title")?.textContent.replace(/\s+/g, " ");
  for (const key of svg.querySelectorAll(":scope g.key")) {
    key.addEventListener("click", () => {
      const hidden = key.classList.toggle("off");
      for (const group of key.closest("svg").querySelectorAll("g:not(.key)")) {
        if (name(group) === name(key)) group.style.display = hidden ? "none" : "";
      }
    });
  }
}
// A box that leaves only the rows with every word that is typed.
const content = document.getElementById("content");
const filter = (hint, parts) => {
  const box = document.createElement("input");
  box.type = "search";
  box.placeholder = hint;
  box.setAttribute("aria-label", hint);
  box.addEventListener("input", () => {
    const words = box.value.toLowerCase().split(/\s+/);
    for (const part of parts()) {
      const rows = [...part.querySelectorAll("tbody tr")];
      for (const row of rows) {
        const text = row.textContent.toLowerCase();
        row.hidden = !words.every((word) => text.includes(word));
      }
      part.hidden = rows.length > 0 && rows.every((row) => row.hidden);
    }
  });
  return box;
};
if (content.dataset.filter) {
  content.prepend(filter(content.dataset.filter, () => content.querySelectorAll("section")));
} else {
  for (const table of content.querySelectorAll("table")) {
    if (table.tBodies[0]?.rows.length > 20) table.parentElement.before(filter("Filter rows", () => [table]));
  }
}
// A table that is wider than the screen says so.
for (const box of content.querySelectorAll(".table")) {
  if (box.scrollWidth > box.clientWidth) box.classList.add("scrolls");
}
