// Opens reports in headless Chromium as a reader would and checks what is drawn and what the mouse does.
//   node page_test.mjs BUILD_DIRECTORY [REPORT.html]     default report: of a simulated trial made here
// Screenshots go to BUILD_DIRECTORY/report_screenshots.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, rmSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { Browser } from './browser.mjs';
import { Layout } from './layout.mjs';
import { checkWords } from './study_page.mjs';

const build = resolve(process.argv[2]);
const shots = join(build, 'report_screenshots');
mkdirSync(shots, { recursive: true });
let checks = 0;

async function check(name, work) {
  await work();
  checks += 1;
  console.log(`ok ${name}`);
}

// Middle of the n-th element, and its size, in the window.
function place(browser, selector, n = 0) {
  return browser.run((wanted, which) => {
    const element = document.querySelectorAll(wanted)[which];
    element.scrollIntoView({ block: 'center' });
    const box = element.getBoundingClientRect();
    return { left: box.left, top: box.top, width: box.width, height: box.height };
  }, selector, n);
}

// Share of the pixels of each canvas that differ from its most frequent colour.
function inked(browser, selector) {
  return browser.run(wanted => [...document.querySelectorAll(wanted)].map(canvas => {
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext('2d', { willReadFrequently: true });
    context.drawImage(canvas, 0, 0);
    const pixels = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
    const counts = new Map();
    for (const pixel of pixels) counts.set(pixel, (counts.get(pixel) || 0) + 1);
    return 1 - Math.max(...counts.values()) / pixels.length;
  }), selector);
}

// Labels of the time axis of each panel: the part of the trial that it shows.
function axes(browser) {
  return browser.run(() => [...document.querySelectorAll('#time-plots .plot')].map(plot =>
    [...plot.querySelectorAll('.dygraph-axis-label-x')].map(label => Number(label.textContent))));
}

async function checkPage(browser, name, { panels, strides }) {
  await check(`${name}: every panel and the force-depth plot are drawn`, async () => {
    const lines = await inked(browser, '#time-plots canvas:nth-of-type(1)');
    assert.equal(lines.length, panels);
    for (const share of lines) assert.ok(share > 0.005, `a panel is blank: ${lines}`);
    const [scatter] = await inked(browser, '#force-depth canvas');
    assert.ok(scatter > 0.01, `force-depth is blank: ${scatter}`);
  });

  await check(`${name}: a row for each stride`, async () => {
    assert.equal(await browser.run(() => document.querySelectorAll('#stride-table tbody tr').length), strides);
  });

  await check(`${name}: dragging in one panel zooms all, a double click shows all`, async () => {
    const before = await axes(browser);
    const plot = await place(browser, '.plot', 2);
    const y = plot.top + plot.height / 2;
    await browser.drag([plot.left + plot.width * 0.5, y], [plot.left + plot.width * 0.7, y]);
    await sleep(300);
    const zoomed = await axes(browser);
    const span = labels => labels[labels.length - 1] - labels[0];
    for (let i = 0; i < zoomed.length; ++i) {
      assert.ok(span(zoomed[i]) < 0.5 * span(before[i]), `panel ${i}: ${before[i]} became ${zoomed[i]}`);
      assert.deepEqual(zoomed[i], zoomed[0]);
    }
    await browser.doubleClick(plot.left + plot.width / 2, y);
    await sleep(300);
    const whole = await axes(browser);
    for (const labels of whole) assert.ok(span(labels) > span(zoomed[0]), `${labels}`);
  });

  await check(`${name}: the pointer reads values in every panel`, async () => {
    await browser.run(() => document.querySelector('#stride-table tbody tr').click());
    const plot = await place(browser, '.plot', 1);
    await browser.point(plot.left + plot.width * 0.5, plot.top + plot.height / 2);
    await sleep(100);
    const read = await browser.run(() => ({
      clock: document.getElementById('clock').textContent,
      values: [...document.querySelectorAll('#time-plots .panel')].map(panel => panel.querySelector('.legend .value').textContent),
    }));
    assert.match(read.clock, /^t = \d+\.\d{3} s$/);
    for (const value of read.values) assert.match(value, /^-?\d/);
  });

  await check(`${name}: a legend's name hides its line`, async () => {
    const before = await inked(browser, '#force-depth canvas');
    await browser.run(() => document.querySelectorAll('#force-depth .legend button[aria-pressed=true]').forEach(b => b.click()));
    const after = await inked(browser, '#force-depth canvas');
    assert.ok(after[0] < before[0], `${before} then ${after}`);
    await browser.run(() => document.querySelectorAll('#force-depth .legend button').forEach(b => b.click()));
  });

  await check(`${name}: dragging a rectangle zooms force against depth`, async () => {
    const plot = await place(browser, '#force-depth canvas');
    const before = await inked(browser, '#force-depth canvas');
    await browser.drag([plot.left + plot.width * 0.4, plot.top + plot.height * 0.3],
      [plot.left + plot.width * 0.6, plot.top + plot.height * 0.6]);
    const after = await inked(browser, '#force-depth canvas');
    assert.notDeepEqual(after, before);
    await browser.doubleClick(plot.left + plot.width / 2, plot.top + plot.height / 2);
  });

  await check(`${name}: every figure follows the theme`, async () => {
    const pictures = () => browser.run(() => [...document.querySelectorAll('#time-plots canvas:nth-of-type(1), #force-depth canvas')]
      .map(canvas => canvas.toDataURL()));
    const before = await pictures();
    await browser.run(() => { document.getElementById('theme').click(); document.getElementById('theme').click(); });
    const after = await pictures();
    before.forEach((picture, i) => assert.notEqual(after[i], picture, `figure ${i} kept its colours`));
    await browser.run(() => document.getElementById('theme').click());
  });

  await check(`${name}: no complaint on the console, no request to a network`, async () => {
    assert.deepEqual(await browser.complaints(), []);
  });
}

async function open(browser, file) {
  await browser.open(file);
  await sleep(500);
}

function sample(name, strides, idle_s) {
  const file = join(build, `${name}.html`);
  execFileSync(join(build, 'bin', 'sample_page'), [file, String(strides), String(idle_s)]);
  return file;
}

// Report of three strides of the simulated robot, made from the log as `hop trial` does.
function trial() {
  const folder = join(build, 'report_trial');
  rmSync(folder, { recursive: true, force: true });
  execFileSync(join(build, 'bin', 'hop'), ['trial', '--strides', '3', '--output', folder]);
  return join(folder, 'trial_001.html');
}

// The paper's programme, one repetition; returns its page and its output with --json.
function programme() {
  const folder = join(build, 'report_paper');
  const printed = execFileSync(join(build, 'bin', 'hop'), ['experiment', 'paper', '--quick', '--json', '--output', folder],
    { stdio: ['ignore', 'pipe', 'ignore'], maxBuffer: 1 << 26 });
  return { page: join(folder, 'paper.html'), numbers: JSON.parse(printed) };
}

// Every figure of a study has lines or points of each visible series and names both axes; nothing is wider
// than the window.
async function checkStudy(browser, name) {
  await check(`${name}: every figure is drawn, with its axes named`, async () => {
    const figures = await browser.run(() => [...document.querySelectorAll('.figures svg')].filter(svg => svg.closest('figure') && !svg.parentElement.closest('svg'))
      .map(svg => ({
        title: svg.getAttribute('aria-label'),
        words: [...svg.querySelectorAll('text')].map(text => text.textContent).filter(text => /[a-z]{2}/i.test(text)),
        series: [...svg.querySelectorAll('.series')].map(group => group.querySelectorAll('circle').length
          + [...group.querySelectorAll('path')].filter(path => path.getAttribute('d').includes('L')).length),
      })));
    assert.ok(figures.length > 0);
    for (const { title, words, series } of figures) {
      assert.ok(words.length >= 2, `${title}: axes ${words}`);
      assert.ok(series.length > 0 && series.every(drawn => drawn > 0), `${title}: ${series}`);
    }
  });
  await check(`${name}: fits a laptop's screen, complains of nothing`, async () => {
    assert.ok(await browser.run(() => document.documentElement.scrollWidth <= window.innerWidth));
    assert.deepEqual(await browser.complaints(), []);
  });
}

// Nothing may overlap, be clipped or have too little contrast, on any screen, light or dark.
function checkLayout(layout, name, file) {
  return check(`${name}: readable at every width, light and dark`, async () => assert.deepEqual(await layout.everywhere(file), []));
}

async function wholePage(browser, width, file) {
  const height = await browser.run(() => document.documentElement.scrollHeight);
  await browser.resize(width, height + 150);
  await sleep(300);
  await browser.screenshot(join(shots, file));
}

async function everything() {
  const browser = await Browser.start({ width: 1440, height: 900 });
  try {
    const layout = await Layout.of(browser);
    for (const [name, strides] of [['sample_none', 0], ['sample_one', 1], ['sample_many', 30]]) await checkLayout(layout, name, sample(name, strides, 0.2));
    await open(browser, sample('sample_one', 1, 0.2));
    await checkPage(browser, 'one stride', { panels: 6, strides: 1 });
    await check('text of a log is shown as text', async () => {
      assert.equal(await browser.run(() => document.title), 'Sample <trial> & co.');
    });

    await check('a request would be noticed, and is not let out', async () => {
      await browser.run(() => { document.body.append(Object.assign(new Image(), { src: 'http://127.0.0.1:9/x.png' })); });
      await sleep(100);
      const complaints = await browser.complaints();
      assert.ok(complaints.some(line => line.includes('Content Security Policy')), `${complaints}`);
    });

    await open(browser, sample('sample_none', 0, 0));
    await check('a trial without a cycle says so', async () => {
      assert.match(await browser.run(() => document.body.innerText), /holds no cycle/);
      assert.deepEqual(await browser.complaints(), []);
    });

    await open(browser, sample('sample_many', 30, 0.2));
    await checkPage(browser, 'thirty strides', { panels: 6, strides: 30 });
    await check('thirty strides: one after the other by button', async () => {
      const next = () => browser.run(() => {
        document.querySelector('#views button[title="Next stride"]').click();
        return document.querySelector('#views select').value;
      });
      await browser.run(() => document.querySelector('#views button').click());
      assert.deepEqual([await next(), await next()], ['Stride 1', 'Stride 2']);
    });
    await browser.screenshot(join(shots, 'thirty_strides.png'));

    // 20 minutes. The spike is one row after three quarters of the time, and the height of the plots must
    // show it.
    await open(browser, sample('sample_long', 20, 60));
    await checkPage(browser, 'twenty minutes', { panels: 6, strides: 20 });
    await check('twenty minutes: one row that stands out is not lost', async () => {
      await browser.run(() => document.querySelector('#views button').click());
      await sleep(300);
      const top = await browser.run(() => Math.max(...[...document.querySelectorAll('#time-plots .plot')[5]
        .querySelectorAll('.dygraph-axis-label-y')].map(label => Number(label.textContent))));
      assert.ok(top >= 400, `the force panel ends at ${top} N`);
    });
    await wholePage(browser, 1440, 'twenty_minutes.png');

    await browser.resize(1366, 768);
    const paper = programme();
    await open(browser, paper.page);
    await checkStudy(browser, 'the programme');
    await check('the programme: its equations are set, its answer stands first', async () => {
      assert.deepEqual(await checkWords(browser), []);
      assert.match(await browser.run(() => document.getElementById('verdict').textContent), /^\d+ of 36 claims hold/);
      assert.ok(await browser.run(() => document.querySelectorAll('#section-1 .math sub, #section-1 .math sup').length) > 10);
    });
    await check('the programme: 36 claims, on the page and as numbers', async () => {
      assert.equal(await browser.run(() => document.querySelectorAll('#section-1 tbody tr').length), 36);
      assert.equal(paper.numbers.claims.length, 36);
    });
    await wholePage(browser, 1366, 'programme.png');
    await checkLayout(layout, 'the programme', paper.page);

    await browser.resize(1440, 1000);
    const page = process.argv[3] ? resolve(process.argv[3]) : trial();
    await checkLayout(layout, 'a trial', page);
    await browser.resize(1366, 768);
    await open(browser, page);
    await check('a trial: the joint fit stands on the first screen of a laptop', async () => {
      const box = await browser.run(() => document.querySelector('#stride-table tbody tr td:last-child').getBoundingClientRect().toJSON());
      assert.ok(box.width > 0 && box.right <= 1366 && box.bottom <= 768, JSON.stringify(box));
    });
    await browser.resize(1440, 1000);
    await open(browser, page);
    const strides = await browser.run(() => document.querySelectorAll('#stride-table tbody tr').length);
    await check('a trial: begins with what is known of the ground', async () => {
      assert.match(await browser.run(() => document.getElementById('answer').textContent), /^Ground: .* mm/);
    });
    await checkPage(browser, 'a trial', { panels: 7, strides: process.argv[3] ? strides : 3 });
    await browser.run(() => window.scrollTo(0, 0));
    await browser.screenshot(join(shots, 'trial_first_screen.png'));
    await wholePage(browser, 1440, 'trial.png');
    await browser.print(join(shots, 'trial.pdf'));
    await check('a trial: opening what is folded, and printing, complains of nothing', async () => {
      await browser.run(() => { document.getElementById('folded').open = true; });
      await sleep(300);
      for (const share of await inked(browser, '#folded-plots canvas:nth-of-type(1)')) assert.ok(share > 0.002, `${share}`);
      assert.deepEqual(await browser.complaints(), []);
    });
  } finally {
    await browser.stop();
  }
}

await everything();
console.log(`${checks} checks`);
