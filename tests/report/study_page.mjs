// Checks of every page that tools/report/study.hpp makes: figures drawn, axes with units, legends that hide, nothing
// wider than a laptop, no complaint, no request.
import assert from 'node:assert/strict';

// Content of each figure: marks of every visible series, words of the axes.
function figures(browser) {
  return browser.run(() => [...document.querySelectorAll('figure.panel')].map(figure => ({
    title: figure.querySelector('figcaption b').textContent,
    folded: figure.closest('details:not([open])') !== null,
    series: [...figure.querySelectorAll('g.series')].map(group => ({
      label: group.dataset.label,
      inked: [...group.querySelectorAll('circle, path, polygon')].filter(mark => {
        const box = mark.getBBox();
        return Number.isFinite(box.x + box.y) && (mark.tagName === 'circle' || box.width + box.height > 0);
      }).length,
    })),
    ticks: {
      x: [...figure.querySelectorAll('svg > text.tick-x')].map(text => text.textContent),
      y: [...figure.querySelectorAll('svg > text.tick-y')].map(text => text.textContent).sort((a, b) => Number(a.replace('−', '-')) - Number(b.replace('−', '-'))),
    },
    words: [...figure.querySelectorAll('svg text')].map(text => text.textContent),
    size: [figure.getBoundingClientRect().width, figure.getBoundingClientRect().height],
    legend: figure.querySelectorAll('.legend button').length,
  })));
}

// Two curves of a figure must differ by more than a shade of one colour, which readers cannot distinguish.
function checkLooks(figure) {
  const look = ({ mark, color, shade, dashed, dotted, hollow }) => [mark, color, dashed, dotted, hollow, mark === 'band' ? shade : 0].join();
  const known = new Map();
  for (const series of figure.series) {
    const twin = known.get(look(series));
    assert.ok(!twin, `${figure.title}: ${twin} and ${series.label} look the same`);
    known.set(look(series), series.label);
  }
}

// A quantity must have the same unit everywhere on the page.
function checkUnits(items) {
  const units = new Map();
  const labels = items.flatMap(item => (item.kind === 'figure' ? [item.x_label, item.y_label] : item.kind === 'table' ? item.columns : []));
  for (const label of labels) {
    const [quantity, unit] = label.split(/, (?=[^,]*$)/);
    if (!unit) continue;
    const known = units.get(quantity) ?? unit;
    if (/^(k|m|µ)?(m|g|s|N|Nm|rad)(\/|$)/.test(unit)) assert.equal(unit, known, `${quantity} stands in ${known} and in ${unit}`);
    units.set(quantity, known);
  }
}

// Ticks of a linear axis: round numbers, evenly spaced, all with the same decimals.
function checkTicks(title, labels) {
  const decimals = new Set(labels.map(label => (label.split('×')[0].split('.')[1] ?? '').length));
  const values = labels.map(label => {
    const [digits, power] = label.replaceAll('−', '-').split('×10');
    return Number(digits) * 10 ** Number([...(power ?? '')].map(one => '⁰¹²³⁴⁵⁶⁷⁸⁹'.indexOf(one)).map(at => (at < 0 ? '-' : at)).join(''));
  });
  const [first, second] = values;
  if (labels.every(label => label === '0' || !label.includes('×'))) assert.ok(decimals.size <= 1, `${title}: ticks ${labels}`);
  assert.ok(labels.length >= 2, `${title}: ticks ${labels}`);
  const step = second - first;
  assert.match((step / 10 ** Math.floor(Math.log10(step) + 1e-9)).toPrecision(3), /^(1|2|5)\.00$|^10\.0$/, `${title}: ticks ${labels}`);
}

// Equations as they were typed, their marks, and stiffnesses with more digits than anybody knows.
export function checkWords(browser) {
  return browser.run(() => {
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    const faults = [];
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      if (node.parentElement.closest('script, style, noscript, pre, code')) continue;
      faults.push(...node.data.match(/[⟦⟧]|\^[\w(-]|\bsqrt\(|<=|>=|\+- |\b(?:sigma|tau|rho|phi|psi)\b|\b\d{5,}(?:\.\d+)?\s(?=N\/m\b)/g)?.filter(word => !/^\d+0\s$/.test(word)) ?? []);
    }
    return faults;
  });
}

export async function checkStudy(browser, file) {
  await browser.open(file);
  const items = await browser.run(() => JSON.parse(document.getElementById('data').textContent).sections.flatMap(section => section.items));
  const wanted = items.filter(item => item.kind === 'figure');
  wanted.forEach(checkLooks);
  checkUnits(items);
  await browser.run(() => document.querySelectorAll('details').forEach(details => { details.open = true; }));
  const drawn = await figures(browser);
  assert.equal(drawn.length, wanted.length);
  assert.ok(drawn.length > 0, 'there is no figure');
  for (const [i, figure] of drawn.entries()) {
    const shown = wanted[i].series.filter(series => series.shown);
    assert.deepEqual(figure.series.map(series => series.label), shown.map(series => series.label), figure.title);
    for (const series of figure.series) assert.ok(series.inked > 0, `${figure.title}: ${series.label} is blank`);
    for (const label of [wanted[i].x_label, wanted[i].y_label]) assert.ok(label.includes('⟦') || figure.words.includes(label), `${figure.title} lacks ${label}`);
    assert.match(wanted[i].y_label, /, \S+/, `${figure.title}: no unit on the y axis`);
    if (!wanted[i].log_x && !wanted[i].categories.length) checkTicks(figure.title, figure.ticks.x);
    if (!wanted[i].log_y) checkTicks(figure.title, figure.ticks.y);
    assert.ok(figure.words.every(word => !/NaN|undefined|null/.test(word)), `${figure.title}: ${figure.words}`);
    assert.ok(figure.size[0] > 300 && figure.size[1] > 150, `${figure.title} is ${figure.size} pixels`);
  }
  assert.deepEqual(await checkWords(browser), [], 'words that no reader should see');
  const overflow = await browser.run(() => document.documentElement.scrollWidth - window.innerWidth);
  assert.ok(overflow <= 0, `the page is ${overflow} pixels wider than a laptop's screen`);
  await checkLegend(browser);
  assert.deepEqual(await browser.complaints(), []);
  return drawn;
}

// A name in a legend must hide its series and show it again.
async function checkLegend(browser) {
  const counts = await browser.run(() => {
    const figure = [...document.querySelectorAll('figure.panel')].find(panel => panel.querySelectorAll('g.series').length > 1);
    if (!figure) return null;
    const button = figure.querySelector('.legend button[aria-pressed=true]');
    const count = () => figure.querySelectorAll('g.series').length;
    const before = count();
    button.click();
    const hidden = count();
    button.click();
    return [before, hidden, count()];
  });
  if (counts) assert.deepEqual(counts.slice(1), [counts[0] - 1, counts[0]]);
}
