// The page of a fault: the check that fired, the reaction, the cure, and the measurements around it.
function start() {
  const data = readData();
  const explained = data.explained;
  theme.start(document.getElementById('theme'));
  fillText(data);
  fillAnswers(explained);
  const verdict = document.getElementById('verdict');
  verdict.textContent = explained.verdict;
  if (!data.time.length) {
    document.querySelector('main').replaceChildren(element('p', {}, 'The file holds no cycle.'));
    return;
  }
  data.panels = panelsFor(explained.faults);
  data.time_label = 'time from the fault, s';
  data.marks = explained.faults.map(fault => ({ time_s: fault.time_s, name: fault.name }));
  if (!data.marks.length) data.marks = [{ time_s: 0, name: 'last cycle' }];

  const whole = [data.time[0], data.time[data.time.length - 1]];
  const views = viewsOf(whole);
  const clock = document.getElementById('clock');
  const plots = new TimePlots(data, document.getElementById('checked-plots'), document.getElementById('other-plots'),
    t => { clock.textContent = t === null ? '' : `t = ${t.toFixed(3)} s`; },
    (from, to) => buttons.forEach((button, i) => button.setAttribute('aria-pressed', String(views[i].range[0] === from && views[i].range[1] === to))));
  const buttons = views.map(view => element('button', {
    type: 'button',
    onclick: () => { plots.unlockHeights(); plots.show(...view.range); },
  }, view.name));
  document.getElementById('views').append(...buttons);
  buttons[0].click();
}

// Views: the whole frame, and the time close to the fault.
function viewsOf(whole) {
  const within = (from, to) => [Math.max(whole[0], from), Math.min(whole[1], to)];
  return [
    { name: 'All', range: whole },
    { name: 'Half a second', range: within(-0.3, 0.2) },
    { name: '50 ms', range: within(-0.03, 0.02) },
  ];
}

// Panels with the channels of the check come first, with its limits. The others are folded below.
function panelsFor(faults) {
  const first = faults[0] || { channels: [], lines: [] };
  const checked = panel => panel.series.some(series => first.channels.includes(series.channel));
  const panels = PANELS.map(panel => ({ ...panel, folded: !checked(panel), lines: checked(panel) ? first.lines : [] }));
  if (panels.every(panel => panel.folded)) panels.forEach(panel => { panel.folded = false; });
  return [...panels.filter(panel => !panel.folded), ...panels.filter(panel => panel.folded)];
}

function fillAnswers(explained) {
  const answers = document.getElementById('answers');
  const box = (heading, ...content) => answers.append(element('section', { className: 'answer' }, element('h2', {}, heading), ...content));
  const line = (className, text) => element('p', { className }, text);
  for (const [i, fault] of explained.faults.entries()) {
    box(i === 0 ? 'The check that fired' : `Then, ${Math.round(1000 * fault.time_s)} ms later: ${fault.name}`,
      line('lead', `${fault.device ? `${fault.device}: ` : ''}${fault.value_text}`),
      line('', fault.quantity),
      line('', `Allowed: ${fault.limit_text}`),
      line('quiet', `Means: ${fault.meaning}.`));
  }
  box('What was done', stepTable(explained.steps), line('quiet', explained.ending));
  for (const fault of explained.faults) box(explained.faults.length > 1 ? `Cure of ${fault.name}` : 'Cure', element('p', {}, ...withCode(fault.cure)));
}

function stepTable(steps) {
  const seconds = t => (t > 0 ? `+${t.toFixed(3)}` : t.toFixed(3));
  return element('div', { className: 'scroll' }, element('table', { className: 'steps' },
    element('thead', {}, element('tr', {}, headerCell('From', 's'), headerCell('To', 's'), headerCell('State', '', 'text'), headerCell('Drives', '', 'text'))),
    element('tbody', {}, ...steps.map(step => element('tr', { className: step.state === 'fault' ? 'bad' : '' },
      element('td', {}, seconds(step.from_s)), element('td', {}, seconds(step.to_s)),
      element('td', { className: 'text' }, step.state.replaceAll('_', ' ')), element('td', { className: 'text' }, step.drives))))));
}

start();
