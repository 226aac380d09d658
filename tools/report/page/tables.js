// Texts and tables of the page.
function fillText(data) {
  const facts = document.getElementById('facts');
  for (const [label, text] of data.facts) facts.append(element('div', {}, element('dt', {}, label), element('dd', {}, text)));
  const answer = document.getElementById('answer');
  if (data.answer) answer.append(...withCode(data.answer[0].toUpperCase() + data.answer.slice(1)));
  else answer?.remove();  // the page of a fault has no such element
  const notes = document.getElementById('notes');
  for (const note of data.notes) notes.append(element('p', {}, note));
  if (data.envelope_rows > 1) {
    notes.append(element('p', {}, `Long trial: between strides the figures show the least and greatest value of each ${data.envelope_rows} cycles.`));
  }
  document.getElementById('configuration').textContent = data.configuration;
  if (!data.configuration) document.getElementById('configuration').parentElement.remove();
  fillEvents(data, document.getElementById('event-table'));
}

function headerCell(title, unit, className) {
  return element('th', { className: className || '' }, title, ...(unit ? [element('small', {}, unit)] : []));
}

function fixed(value, digits) {
  return value === null ? '–' : value.toFixed(digits);
}

// onChoose(stride) is called if a row is clicked. Returns the rows in the order of the strides.
function fillStrides(data, table, onChoose) {
  table.append(element('thead', {}, element('tr', {},
    headerCell('Stride'), headerCell('Touchdown speed', 'm/s'), headerCell('Touchdown', 's', 'when'), headerCell('Switch', 's', 'when'),
    headerCell('Liftoff', 's', 'when'), headerCell('Peak force', 'N', 'detail'), headerCell('Depth', 'mm'),
    ...TREATMENTS.map(treatment => headerCell(treatment.label, 'N/m, 95 % interval', classOf(treatment))))));
  const rows = data.strides.map(stride => {
    const row = element('tr', { tabIndex: 0, title: 'Show this stride' },
      element('td', {}, String(stride.number)),
      element('td', {}, fixed(stride.touchdown_speed_mps, 3)),
      element('td', { className: 'when' }, fixed(stride.touchdown_s, 3)),
      element('td', { className: 'when' }, fixed(stride.switch_s, 3)),
      element('td', { className: 'when' }, fixed(stride.liftoff_s, 3)),
      element('td', { className: 'detail' }, fixed(stride.peak_force_N, 1)),
      element('td', {}, fixed(stride.max_depth_m === null ? null : 1000 * stride.max_depth_m, 1)),
      ...stiffnessCells(stride));
    row.onclick = () => onChoose(stride);
    row.onkeydown = event => { if (event.key === 'Enter') onChoose(stride); };
    return row;
  });
  table.append(element('tbody', {}, ...rows));
  if (!rows.length) table.append(element('caption', {}, 'No stride in this trial.'));
  fitTable(table.parentElement);
  return rows;
}

// On a small screen only the joint fit is shown.
function classOf(treatment) {
  return treatment.key === 'joint' ? '' : 'line';
}

// If no treatment has a value, all for the same reason, one cell spans the columns.
function stiffnessCells(stride) {
  const fits = TREATMENTS.map(treatment => stride[treatment.key]);
  if (fits.some(fit => fit.valid || fit.value_N_per_m !== null || fit.reason !== fits[0].reason)) {
    return TREATMENTS.map((treatment, i) => stiffnessCell(fits[i], classOf(treatment)));
  }
  const made = stiffnessCell(fits[0], '');
  made.colSpan = TREATMENTS.length;
  made.dataset.name = 'stiffness';
  return [made];
}

function stiffnessCell(fit, className) {
  const value = element('span', { className: fit.valid ? 'valid' : 'invalid' }, fixed(fit.value_N_per_m, 0));
  const [low, high] = fit.ci95_N_per_m;
  return element('td', { title: `${fit.samples} samples`, className }, value, fit.valid
    ? element('small', {}, `${fixed(low, 0)} to ${fixed(high, 0)}`)
    : element('small', { className: 'why' }, `not valid: ${fit.reason}`));
}

function fillEvents(data, table) {
  table.append(element('thead', {}, element('tr', {}, headerCell('Time', 's'), headerCell('Stride'),
    headerCell('Event', '', 'text'), headerCell('Reason', '', 'text'), headerCell('Values', '', 'text'))));
  table.append(element('tbody', {}, ...data.events.map(event => element('tr', {},
    element('td', {}, event.time_s.toFixed(3)), element('td', {}, event.stride ? String(event.stride) : ''),
    element('td', { className: 'text' }, event.name), element('td', { className: 'text' }, event.reason),
    element('td', { className: 'text' }, event.values)))));
  fitTable(table.parentElement);
}
