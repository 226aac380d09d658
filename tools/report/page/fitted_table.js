// Pixels, about ten lines: a higher row is easier to read as a card.
const kHighRow = 190;

// Fits a table into a limited width: as it is; or with cells of several lines; or each row as a card that has
// a line with the column's name for each cell. No column is hidden behind a scroll bar.
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

// Column name with unit, such as "stiffness, N/m", of a header cell that contains both.
function columnName(cell) {
  const unit = cell.querySelector('small');
  const title = [...cell.childNodes].filter(node => node !== unit).map(node => node.textContent).join('');
  return unit ? `${title}, ${unit.textContent}` : title;
}
