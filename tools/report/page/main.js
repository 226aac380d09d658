// Connects the parts of the page.
function start() {
  const data = readData();
  theme.start(document.getElementById('theme'));
  fillText(data);
  document.getElementById('key').append(
    element('span', {}, element('i', { className: 'compression' }), 'compression'),
    element('span', {}, element('i', { className: 'extension' }), 'extension'));

  const clock = document.getElementById('clock');
  let timePlots = null;
  let forceDepth = null;
  const showInstant = t => { clock.textContent = t === null ? '' : `t = ${t.toFixed(3)} s`; };

  if (!data.time.length) {
    document.querySelector('main').replaceChildren(element('p', {}, 'This trial holds no cycle.'));
    fillStrides(data, document.getElementById('stride-table'), () => {});
    return;
  }
  forceDepth = new ForceDepth(data, document.getElementById('force-depth'), t => timePlots.point(t));
  timePlots = new TimePlots(data, document.getElementById('time-plots'), document.getElementById('folded-plots'), t => {
    showInstant(t);
    forceDepth.point(t);
  }, (from, to) => marked(from, to));
  drawStiffness(data, document.getElementById('stiffness'));

  const whole = [data.time[0], data.time[data.time.length - 1]];
  const views = [{ name: 'Whole trial', range: whole, strides: data.strides }];
  for (const stride of data.strides) views.push({ name: `Stride ${stride.number}`, range: around(stride, whole), strides: [stride] });
  const choose = view => {
    timePlots.unlockHeights();
    timePlots.show(...view.range);
    forceDepth.show(view.strides);
  };
  const rows = fillStrides(data, document.getElementById('stride-table'),
    stride => choose(views[1 + data.strides.indexOf(stride)]));
  const switcher = views.length > 12 ? strideMenu(views, choose) : strideButtons(views, choose);

  // Marks the view that the panels show, if any.
  function marked(from, to) {
    const here = views.findIndex(view => view.range[0] === from && view.range[1] === to);
    switcher(here);
    rows.forEach((row, i) => row.classList.toggle('shown', i + 1 === here));
  }
  choose(views[Math.min(1, views.length - 1)]);
}

// Two ways to choose a view. Each returns a function that marks the view of a given number; -1: none.
function strideButtons(views, choose) {
  const buttons = views.map(view => element('button', { type: 'button', onclick: () => choose(view) }, view.name));
  document.getElementById('views').append(...buttons);
  return here => buttons.forEach((button, i) => button.setAttribute('aria-pressed', String(i === here)));
}

function strideMenu(views, choose) {
  const menu = element('select', { title: 'Part shown', onchange: () => choose(views[menu.selectedIndex]) },
    ...views.map(view => element('option', {}, view.name)));
  const step = by => () => choose(views[Math.max(0, Math.min(views.length - 1, menu.selectedIndex + by))]);
  document.getElementById('views').append(
    element('button', { type: 'button', onclick: () => choose(views[0]) }, views[0].name),
    element('button', { type: 'button', title: 'Stride before', onclick: step(-1) }, '‹'),
    menu,
    element('button', { type: 'button', title: 'Next stride', onclick: step(1) }, '›'));
  return here => { menu.selectedIndex = here; };
}

// Time range of a stride with margins, limited to the trial.
function around(stride, whole) {
  const end = stride.liftoff_s ?? whole[1];
  const margin = 0.35 * (end - stride.touchdown_s);
  return [Math.max(whole[0], stride.touchdown_s - margin), Math.min(whole[1], end + margin)];
}

start();
