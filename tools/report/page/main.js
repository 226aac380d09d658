// Ties the parts of the page together.
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
  const rows = fillStrides(data, document.getElementById('stride-table'), stride => choose(views[1 + data.strides.indexOf(stride)]));
  const buttons = views.map(view => element('button', { type: 'button', onclick: () => choose(view) }, view.name));
  document.getElementById('views').append(...buttons);

  // Shows which of the views, if any, the panels are at.
  function marked(from, to) {
    views.forEach((view, i) => {
      const here = view.range[0] === from && view.range[1] === to;
      buttons[i].setAttribute('aria-pressed', String(here));
      if (i > 0) rows[i - 1].classList.toggle('shown', here);
    });
  }
  choose(views[Math.min(1, views.length - 1)]);
}

// A stride with what leads to it and what follows, inside the trial.
function around(stride, whole) {
  const end = stride.liftoff_s ?? whole[1];
  const margin = 0.35 * (end - stride.touchdown_s);
  return [Math.max(whole[0], stride.touchdown_s - margin), Math.min(whole[1], end + margin)];
}

start();
