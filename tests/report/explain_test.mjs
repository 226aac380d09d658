// Opens the page of a freeze frame of every fault in headless Chromium, on a laptop and on a phone: the first screen names
// fault, value, limit, reaction and cure; every panel is drawn; nothing is wider than the window, no complaint, no request.
//   node explain_test.mjs BUILD_DIRECTORY [--all | PAGE.html…]   default: every sixth of the pages that freeze_tests writes,
//                                                                a second or two each; --all: one of each fault
// Screenshots go to BUILD_DIRECTORY/report_screenshots.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join, resolve } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { Browser } from './browser.mjs';
import { Layout } from './layout.mjs';

const build = resolve(process.argv[2]);
const shots = join(build, 'report_screenshots');
mkdirSync(shots, { recursive: true });
const scratch = mkdtempSync(join(tmpdir(), 'sandhopper-explain-'));

function pagesOfEveryFault() {
  execFileSync(join(build, 'bin/freeze_tests'), ['--gtest_filter=FreezeFrames.*'],
    { env: { ...process.env, SANDHOPPER_FREEZE_PAGES: scratch }, stdio: ['ignore', 'ignore', 'inherit'] });
  return readdirSync(scratch).sort().map(file => join(scratch, file));
}

function shown(browser) {
  return browser.run(() => {
    const top = document.documentElement;
    const blank = [...document.querySelectorAll('.plot canvas:nth-of-type(1)')].filter(canvas => {
      const pixels = new Uint32Array(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.buffer);
      return new Set(pixels).size < 3;
    }).length;
    return {
      title: document.title,
      text: document.body.innerText,
      verdict: document.getElementById('verdict').textContent,
      headings: [...document.querySelectorAll('.answer h2')].map(heading => heading.textContent.toLowerCase()),
      steps: document.querySelectorAll('.steps tbody tr').length,
      checked: document.querySelectorAll('#checked-plots .panel').length,
      panels: document.querySelectorAll('.panel').length,
      blank,
      wider: top.scrollWidth - top.clientWidth,
      width: top.clientWidth,
    };
  });
}

async function check(browser, page, width, height) {
  await browser.resize(width, height);
  await browser.open(page);
  await sleep(150);
  const name = basename(page, '.html');
  const seen = await shown(browser);
  await browser.screenshot(join(shots, `explain_${name}_${width}.png`));
  assert.ok(seen.verdict.length > 10, seen.verdict);
  assert.deepEqual(seen.headings.slice(0, 1), ['the check that fired'], name);
  assert.ok(seen.headings.includes('what was done') && seen.headings.some(heading => heading.startsWith('cure')), seen.headings.join());
  assert.ok(seen.steps >= 1, 'no step of the reaction');
  assert.ok(seen.checked >= 1, `${name}: no panel shows what the check looked at`);
  assert.ok(seen.panels >= 8, `${name}: ${seen.panels} panels`);
  assert.equal(seen.blank, 0, `${name}: ${seen.blank} panels are blank`);
  assert.ok(seen.wider <= 0, `${name}: ${seen.wider} pixels wider than ${seen.width}`);
  assert.doesNotMatch(seen.text, /NaN|undefined/);
  assert.deepEqual(await browser.complaints(), [], name);
}

const browser = await Browser.start({ width: 1366, height: 768 });
try {
  const layout = await Layout.of(browser);
  const all = process.argv.includes('--all');
  const named = process.argv.slice(3).filter(file => file !== '--all').map(file => resolve(file));
  const pages = named.length ? named : pagesOfEveryFault().filter((_, i) => all || i % 6 === 0);
  for (const page of pages) {
    await check(browser, page, 1366, 768);
    await check(browser, page, 400, 800);
    assert.deepEqual(await layout.everywhere(page), [], basename(page));
  }
  console.log(`ok ${pages.length} pages at 1366, 800 and 400 pixels, light and dark`);
} finally {
  await browser.stop();
  rmSync(scratch, { recursive: true });
}
