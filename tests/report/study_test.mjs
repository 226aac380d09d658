// Opens the page of `hop terrain` in headless Chromium: every figure drawn, axes with units, no complaint, no request.
//   node study_test.mjs BUILD_DIRECTORY [STUDY.html…]     default: simulated hops and intrusions made here
// Screenshots go to BUILD_DIRECTORY/report_screenshots.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join, resolve } from 'node:path';
import { Browser } from './browser.mjs';
import { Layout } from './layout.mjs';
import { checkStudy } from './study_page.mjs';

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

// On a small screen nothing is wider than the screen, and text in figures keeps its size.
async function narrow(browser, name) {
  for (const width of [800, 400]) {
    await browser.resize(width, 900);
    await new Promise(resolve => setTimeout(resolve, 300));
    const { overflow, scales } = await browser.run(() => ({
      overflow: document.documentElement.scrollWidth - window.innerWidth,
      scales: [...document.querySelectorAll('figure.panel svg')].filter(svg => svg.clientWidth > 0)
        .map(svg => svg.clientWidth / svg.viewBox.baseVal.width),
    }));
    assert.ok(overflow <= 0, `${name}: ${overflow} pixels wider than a screen of ${width}`);
    for (const scale of scales) assert.ok(Math.abs(scale - 1) < 0.02, `${name}: letters are drawn ${scale} times as large at ${width}`);
  }
}

const browser = await Browser.start({ width: 1366, height: 768 });
try {
  const layout = await Layout.of(browser);
  const named = process.argv.slice(3).map(file => resolve(file));
  const pages = named.length ? named : ['hopper', 'intruder'].map(simulated);
  for (const [i, file] of pages.entries()) {
    const drawn = await checkStudy(browser, file);
    console.log(`ok ${basename(file)}: ${drawn.length} figures, ${drawn.flatMap(figure => figure.series).length} series`);
    await narrow(browser, basename(file));
    assert.deepEqual(await layout.everywhere(file), [], basename(file));
    await browser.resize(1366, 2400);
    await browser.screenshot(join(shots, `study_${i + 1}.png`));
    await browser.resize(1366, 768);
  }
} finally {
  await browser.stop();
  rmSync(scratch, { recursive: true });
}
