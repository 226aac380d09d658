// Runs `hop diagnose` on small concealed campaigns and opens its page in headless Chromium: the first screen of a laptop
// answers where, what, how sure, how much better and what next; every figure is drawn, no complaint, no request.
//   node diagnosis_test.mjs BUILD_DIRECTORY [CAMPAIGN…]     default: campaigns made here
// Screenshots go to BUILD_DIRECTORY/report_screenshots.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { Browser } from './browser.mjs';
import { Layout } from './layout.mjs';
import { checkStudy } from './study_page.mjs';

const build = resolve(process.argv[2]);
const hop = join(build, 'bin/hop');
const shots = join(build, 'report_screenshots');
mkdirSync(shots, { recursive: true });
const scratch = mkdtempSync(join(tmpdir(), 'sandhopper-diagnosis-'));

function concealed(name, ...what) {
  const folder = join(scratch, name);
  execFileSync(hop, ['conceal', '--output', folder, '--campaigns', '1', '--plant', 'falling_body', '--trials', '6', ...what]);
  return join(folder, 'campaigns/001');
}

const kAnswers = ['Where', 'What', 'How sure', 'How much better', 'What next'];

// Content of the first screen, and its lower end.
function firstScreen(browser) {
  return browser.run(() => ({
    verdict: document.getElementById('verdict').textContent,
    boxes: [...document.querySelectorAll('.answer')].map(box => ({
      heading: box.querySelector('h2').textContent,
      lead: box.querySelector('.lead').textContent,
      text: box.textContent,
      bottom: box.getBoundingClientRect().bottom,
    })),
    italics: [...document.querySelectorAll('.equation i')].length,
  }));
}

// Largest number of lines of a sentence in the table of what was found.
function linesOfSentences(browser) {
  return browser.run(() => {
    const title = [...document.querySelectorAll('section h2')].find(heading => heading.textContent === 'What was found');
    return Math.max(...[...title.parentElement.querySelectorAll('td[data-name="what it says"]')].map(cell => {
      const words = document.createRange();
      words.selectNodeContents(cell);
      return new Set([...words.getClientRects()].map(line => Math.round(line.top))).size;
    }));
  });
}

async function check(browser, layout, campaign, i) {
  const said = JSON.parse(execFileSync(hop, ['diagnose', campaign, '--output', join(scratch, `answer${i}`), '--json'], { stdio: ['ignore', 'pipe', 'ignore'] }));
  const page = join(scratch, `answer${i}`, 'diagnosis.html');
  assert.deepEqual(JSON.parse(readFileSync(join(scratch, `answer${i}`, 'diagnosis.json'))), said);
  assert.equal(existsSync(join(scratch, `answer${i}`, 'corrected.toml')), said.effects.some(effect => !effect.id.startsWith('unknown@')));
  await browser.open(page);
  const { verdict, boxes, italics } = await firstScreen(browser);
  await browser.screenshot(join(shots, `diagnosis_${i + 1}.png`));
  assert.ok(verdict.length > 20, verdict);
  assert.deepEqual(boxes.map(box => box.heading), kAnswers);
  for (const box of boxes) {
    assert.ok(box.lead, `${box.heading} is not answered`);
    assert.ok(box.bottom <= 768, `${box.heading} ends at ${box.bottom} pixels, below the first screen`);
    assert.doesNotMatch(box.text, /NaN|undefined|null|inf\b/);
  }
  for (const effect of said.effects.slice(0, 2)) assert.ok(boxes[1].text.includes(effect.statement), effect.id);
  if (said.effects.length) assert.ok(await linesOfSentences(browser) <= 4, 'a sentence of "What was found" is squeezed into a narrow column');
  if (said.effects.length === 1) assert.ok(italics > 0, 'the equation is not set');
  if (said.verdict === 'consistent') assert.match(boxes[0].lead, /Nowhere/);
  assert.ok(boxes[4].text.length > 20, 'nothing is said of the next trial');
  const drawn = await checkStudy(browser, page);
  assert.deepEqual(await layout.everywhere(page), [], campaign);
  console.log(`ok ${said.verdict} ${said.detail ?? ''}: ${drawn.length} figures; next: ${boxes[4].lead}`);
  return said.verdict;
}

const browser = await Browser.start({ width: 1366, height: 768 });
try {
  const named = process.argv.slice(3).map(folder => resolve(folder));
  const campaigns = named.length ? named : [
    concealed('null', '--kind', 'null', '--seed', '11'),
    concealed('drag', '--effect', 'air.quadratic_drag', '--size', '2', '--seed', '12'),
    concealed('class', '--kind', 'indistinguishable', '--seed', '7101'),
  ];
  const layout = await Layout.of(browser);
  const verdicts = [];
  for (const [i, campaign] of campaigns.entries()) verdicts.push(await check(browser, layout, campaign, i));
  if (!named.length) assert.deepEqual(verdicts.slice(0, 2), ['consistent', 'missing_physics']);
} finally {
  await browser.stop();
  rmSync(scratch, { recursive: true });
}
