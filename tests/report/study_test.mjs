// Opens the page of `hop terrain` in headless Chromium: every figure drawn, axes with units, no complaint, no request.
//   node study_test.mjs BUILD_DIRECTORY [STUDY.html…]     default: simulated hops and intrusions made here
// Screenshots go to BUILD_DIRECTORY/report_screenshots.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join, resolve } from 'node:path';
import { Browser } from './browser.mjs';

const build = resolve(process.argv[2]);
const shots = join(build, 'report_screenshots');
mkdirSync(shots, { recursive: true });
const scratch = mkdtempSync(join(tmpdir(), 'sandhopper-study-'));

function simulated(plant) {
  const folder = join(scratch, plant);
  const hop = join(build, 'bin/hop');
  execFileSync(hop, ['campaign', 'make', '--plant', plant, '--trials', '10', '--output', folder]);
  execFileSync(hop, ['terrain', folder, '--output', folder]);
  return join(folder, 'terrain.html');
}

// What stands in each figure: marks of every shown series, words of the axes.
function figures(browser) {
  return browser.run(() => [...document.querySelectorAll('figure.panel')].map(figure => ({
    title: figure.querySelector('figcaption b').textContent,
    series: [...figure.querySelectorAll('g.series')].map(group => ({
      label: group.dataset.label,
      inked: [...group.querySelectorAll('circle, path, polygon')].filter(mark => {
        const box = mark.getBBox();
        return Number.isFinite(box.x + box.y) && (mark.tagName === 'circle' || box.width + box.height > 0);
      }).length,
    })),
    words: [...figure.querySelectorAll('svg text')].map(text => text.textContent),
    size: [figure.getBoundingClientRect().width, figure.getBoundingClientRect().height],
    legend: figure.querySelectorAll('.legend button').length,
  })));
}

async function check_page(browser, file) {
  await browser.open(file);
  const wanted = await browser.run(() => JSON.parse(document.getElementById('data').textContent).sections
    .flatMap(section => section.items.filter(item => item.kind === 'figure')));
  const drawn = await figures(browser);
  assert.equal(drawn.length, wanted.length);
  assert.ok(drawn.length > 0, 'there is no figure');
  for (const [i, figure] of drawn.entries()) {
    const shown = wanted[i].series.filter(series => series.shown);
    assert.deepEqual(figure.series.map(series => series.label), shown.map(series => series.label), figure.title);
    for (const series of figure.series) assert.ok(series.inked > 0, `${figure.title}: ${series.label} is blank`);
    for (const label of [wanted[i].x_label, wanted[i].y_label]) assert.ok(figure.words.includes(label), `${figure.title} lacks ${label}`);
    assert.match(wanted[i].y_label, /, \S+/, `${figure.title}: no unit on the y axis`);
    assert.ok(figure.words.every(word => !/NaN|undefined|null/.test(word)), `${figure.title}: ${figure.words}`);
    assert.ok(figure.size[0] > 300 && figure.size[1] > 150, `${figure.title} is ${figure.size} pixels`);
  }
  const overflow = await browser.run(() => document.documentElement.scrollWidth - window.innerWidth);
  assert.ok(overflow <= 0, `the page is ${overflow} pixels wider than a laptop's screen`);
  await check_legend(browser);
  assert.deepEqual(await browser.complaints(), []);
  console.log(`ok ${basename(file)}: ${drawn.length} figures, ${drawn.flatMap(figure => figure.series).length} series`);
}

// A name in a legend hides its series and brings it back.
async function check_legend(browser) {
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

const browser = await Browser.start({ width: 1366, height: 768 });
try {
  const named = process.argv.slice(3).map(file => resolve(file));
  const pages = named.length ? named : ['hopper', 'intruder'].map(simulated);
  for (const [i, file] of pages.entries()) {
    await check_page(browser, file);
    await browser.resize(1366, 2400);
    await browser.screenshot(join(shots, `study_${i + 1}.png`));
    await browser.resize(1366, 768);
  }
} finally {
  await browser.stop();
  rmSync(scratch, { recursive: true });
}
