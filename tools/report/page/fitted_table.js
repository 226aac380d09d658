// Pixels of a row, about ten lines: a higher one is read more easily as a card.
const kHighRow = 190;

// A table in a place of limited width: in lines as they are; else with cells that may take several lines; else each row
// as a card, a line for each cell with its column's name. No column is ever hidden behind a scroll bar.
function fitTable(place) {
  const table = place.querySelector('table');
  if (!table?.tHead || !table.tBodies.length) return;
  const names = [...table.tHead.rows[0].cells].map(columnName);
  for (const row of table.tBodies[0].rows) {
    [...row.cells].forEach((cell, i) => { cell.dataset.name ??= names[i] ?? ''; });
  }
  let width = 0;
  const fit = () => {
    const now = place.parentElement.clientWidth;
    if (now === width) return;
    width = now;
    for (const form of ['lines', 'tight', 'cards']) {
      table.dataset.form = form;
      const high = form === 'tight' && [...table.tBodies[0].rows].some(row => row.offsetHeight > kHighRow);
      if (place.scrollWidth <= place.clientWidth && !high) return;
    }
  };
  new ResizeObserver(fit).observe(place.parentElement);
  addEventListener('beforeprint', () => { table.dataset.form = 'tight'; });
  addEventListener('afterprint', () => { width = 0; fit(); });
}

// "stiffness, N/m" of a header cell that holds both.
function columnName(cell) {
  const unit = cell.querySelector('small');
  const title = [...cell.childNodes].filter(node => node !== unit).map(node => node.textContent).join('');
  return unit ? `${title}, ${unit.textContent}` : title;
}
