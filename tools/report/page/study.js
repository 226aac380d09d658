// Builds the page of a study: contents, sections, paragraphs, tables and figures.
const study = JSON.parse(document.getElementById('data').textContent);
theme.start(document.getElementById('theme'));

for (const [label, text] of study.facts) {
  document.getElementById('facts').append(element('div', {}, element('dt', {}, label), element('dd', {}, ...withMath(text))));
}
showAnswers(study);
for (const text of study.warnings) document.getElementById('notes').append(element('p', {}, ...withMath(text)));

study.sections.forEach((section, i) => {
  const id = `section-${i + 1}`;
  document.getElementById('contents').append(element('a', { href: `#${id}` }, section.title));
  const place = element('section', { id });
  document.getElementById('sections').append(place);
  let body = place;
  if (section.folded) {
    body = element('details', {}, element('summary', {}, section.title));
    place.append(body);
  } else {
    place.append(element('h2', {}, section.title));
  }
  fillSection(section, body);
});

// Consecutive figures share a grid.
function fillSection(section, body) {
  let grid = null;
  section.items.forEach((item, i) => {
    if (item.kind !== 'figure') grid = null;
    if (item.kind === 'text') body.append(element('p', {}, ...withMath(item.text)));
    if (item.kind === 'table') body.append(tableOf(item));
    if (item.kind !== 'figure') return;
    if (!grid) body.append(grid = element('div', { className: 'figures' }));
    const alone = !item.wide && grid.childElementCount === 0 && section.items[i + 1]?.kind !== 'figure';
    const panel = element('figure', { className: `panel${item.wide ? ' wide' : ''}${alone ? ' lone' : ''}` });
    grid.append(panel);
    new StudyFigure(item, panel, item.wide ? 1240 : 600);
  });
}

function shadeOf(share) {
  return `color-mix(in srgb, var(--orange) ${Math.round(42 * share)}%, transparent)`;
}

function tableOf(table) {
  const cell = (tag, text, i, shade) => {
    const made = element(tag, { className: i < table.text_columns ? 'text' : String(text).includes(' ') ? '' : 'one' }, ...(tag === 'td' && table.columns[i] === 'equation' ? mathOf(text) : breakable(withMath(text))));
    if (tag === 'td' && table.columns[i] === 'equation' && text.length <= kShortEquation) made.classList.add('one');
    if (shade) made.style.background = `linear-gradient(90deg, ${shadeOf(shade[0])} 50%, ${shadeOf(shade[1])} 50%)`;
    return made;
  };
  const head = element('thead', {}, element('tr', {}, ...table.columns.map((name, i) => {
    const [title, unit] = name.split(/, (?=[^,]*$)/);
    const made = cell('th', title, i);
    if (unit) made.append(element('small', {}, unit));
    return made;
  })));
  const rows = table.rows.map((row, i) => element('tr', { className: table.row_marks[i] ?? '' }, ...row.map((text, j) => cell('td', text, j, table.shades[i]?.[j]))));
  const made = element('div', { className: 'table' },
    ...(table.title ? [element('h3', {}, ...withMath(table.title))] : []),
    rows.length
      ? element('div', { className: table.whole ? 'scroll whole' : 'scroll' }, element('table', {}, head, element('tbody', {}, ...rows)))
      : element('p', { className: 'note' }, 'No entry.'),
    ...(table.note ? [element('p', { className: 'note' }, ...withMath(table.note))] : []));
  if (rows.length) fitTable(made.querySelector('.scroll'));
  return made;
}
