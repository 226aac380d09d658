// The documentation's pages in headless Chromium, opened from their folder: nothing is asked of a network, every page holds on a
// laptop, a tablet and a phone, light and dark, the search finds what it should, the phone's menu opens.
//   node site.mjs BUILD_FOLDER [PAGE.html…]   the pages that tools/docs/build left in BUILD_FOLDER/docs; default: all of them
// Screenshots go to BUILD_FOLDER/docs_screenshots.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readdirSync, readFileSync } from 'node:fs';
import { join, relative, resolve } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { Browser } from '../report/browser.mjs';
import { Layout } from '../report/layout.mjs';

const build = resolve(process.argv[2]);
const site = join(build, 'docs');
const shots = join(build, 'docs_screenshots');
assert.ok(existsSync(join(site, 'index.html')), `${site} holds no pages: run tools/docs/build first`);
mkdirSync(shots, { recursive: true });
const pages = readdirSync(site, { recursive: true }).filter((file) => file.endsWith('.html')).sort();
const named = process.argv.slice(3);
const kSizes = [1366, 800, 400];
const kLookedAt = ['index.html', 'guide/index.html', 'guide/glossary.html', 'guide/tutorial_terrain.html', 'guide/safety.html',
  'guide/benchmark.html', 'reference/keys.html', 'reference/effects.html'];

// The page of effects names each effect of the source, and no other.
{
  const effects = new URL('../../tools/diagnose/effects/', import.meta.url).pathname;
  const sources = readdirSync(effects, { recursive: true }).filter((file) => file.endsWith('.cpp')).map((file) => readFileSync(join(effects, file), 'utf8'));
  const known = sources.flatMap((text) => [...text.matchAll(/(?:\.id = |scale_effect\(\s*)"([a-z_]+\.[a-z_]+)"/g)].map((match) => match[1]));
  const shown = [...readFileSync(join(site, 'reference/effects.html'), 'utf8').matchAll(/<td><code>([a-z_]+\.[a-z_]+)<\/code><\/td>/g)].map((match) => match[1]);
  assert.doesNotMatch(readFileSync(join(site, 'reference/effects.html'), 'utf8'), /\\\|/, 'an equation shows a backslash');
  assert.ok(known.length > 60, `${known.length} effects in the source`);
  assert.deepEqual([...new Set(shown)].sort(), [...new Set(known)].sort());
}

// No page loads a file from a network. Links for readers are no requests.
for (const page of pages)
  for (const [tag] of readFileSync(join(site, page), 'utf8').matchAll(/<(?:script|link|img|iframe|source)\b[^>]*>/g))
    assert.doesNotMatch(tag, /(?:src|href)="(?:https?:)?\/\//, `${page}: ${tag}`);
for (const file of ['site.js', 'style.css'])
  assert.doesNotMatch(readFileSync(join(site, file), 'utf8'), /https?:\/\//, `${file} names an address`);

const wait = async (browser, condition, what) => {
  for (let i = 0; i < 100; ++i) {
    if (await browser.run(condition)) return;
    await sleep(50);
  }
  assert.fail(what);
};

// Equations that stand as they were typed. Code may hold them.
function rawMaths(browser) {
  return browser.run(() => {
    const walker = document.createTreeWalker(document.querySelector('main'), NodeFilter.SHOW_TEXT);
    const raw = [];
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      if (node.parentElement.closest('pre, code, script, style')) continue;
      raw.push(...node.data.match(/(?<![\w.])d?[A-Za-z]_[A-Za-z0-9]{1,3}(?!\w|\.\w)|\^[\w(-]|\bsqrt\(|\+-|<=|>=/g) ?? []);
    }
    return raw;
  });
}

function seen(browser) {
  return browser.run(() => {
    const top = document.documentElement;
    const channel = (text) => text.match(/[\d.]+/g).slice(0, 3).map((value) => {
      const v = value / 255;
      return v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
    });
    const light = (text) => channel(text).reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
    const contrast = (a, b) => (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    const paper = light(getComputedStyle(document.body).backgroundColor);
    const link = document.querySelector('main a');
    return {
      wider: top.scrollWidth - top.clientWidth,
      paper,
      ink: contrast(light(getComputedStyle(document.body).color), paper),
      link: link ? contrast(light(getComputedStyle(link).color), paper) : 21,
      aside: !!document.querySelector('aside')?.offsetParent,
      menu: getComputedStyle(document.getElementById('menu')).display !== 'none',
    };
  });
}

async function look(browser, page, width, theme) {
  await browser.resize(width, 900);
  await browser.open(join(site, page));
  await browser.run((chosen) => { document.documentElement.dataset.theme = chosen; }, theme);
  assert.deepEqual(await rawMaths(browser), [], `${page}: equations as typed`);
  const found = await seen(browser);
  const where = `${page} at ${width}, ${theme}`;
  assert.ok(found.wider <= 0, `${where}: ${found.wider} pixels wider than the window`);
  assert.ok(theme === 'dark' ? found.paper < 0.05 : found.paper > 0.8, `${where}: paper ${found.paper}`);
  assert.ok(found.ink > 7 && found.link > 4.5, `${where}: contrast ${found.ink}, links ${found.link}`);
  assert.equal(found.menu, width > 896, `${where}: menu ${found.menu}`);
  assert.deepEqual(await browser.complaints(), [], where);
  if (kLookedAt.includes(page)) await browser.screenshot(join(shots, `${page.replaceAll('/', '_').replace('.html', '')}_${width}_${theme}.png`));
}

async function searchFor(browser, text) {
  await browser.run((words) => {
    const input = document.getElementById('search-words');
    input.focus();
    input.value = words;
    input.dispatchEvent(new Event('input'));
  }, text);
  await wait(browser, () => document.querySelector('#search-results').children.length > 0, `no answer to '${text}'`);
  return browser.run(() => [...document.querySelectorAll('#search-results a')].map((link) => link.getAttribute('href').replace(/^(\.\.?\/)+/, '')));
}

async function checkSearch(browser, width) {
  await browser.resize(width, 900);
  for (const from of ['index.html', 'tools/campaign/index.html']) {
    for (const [text, wanted] of [
      ['noise floor', /guide\/glossary/], ['tangent stiffness', /guide\/glossary/], ['e-stop', /guide\/(safety|wiring)/],
      ['friction_switch_speed_radps', /reference\/keys/], ['stifness', /./], ['hop conceal', /./], ['bus_off', /reference\/faults.*bus_off/],
    ]) {
      await browser.open(join(site, from));
      const found = await searchFor(browser, text);
      assert.ok(found.slice(0, 6).some((link) => wanted.test(link)), `'${text}' found ${found.join(' ')}`);
    }
    if (from === 'index.html') await browser.screenshot(join(shots, `search_${width}.png`));
    await browser.open(join(site, from));
    assert.deepEqual(await searchFor(browser, 'xylophone zebra'), []);
    await searchFor(browser, 'noise floor');
    await browser.run(() => document.getElementById('search').requestSubmit());
    await wait(browser, () => location.pathname.includes('glossary'), 'Enter did not open the first result');
    assert.deepEqual(await browser.complaints(), [], `search from ${from}`);
  }
}

async function checkMenuOfAPhone(browser) {
  await browser.resize(400, 800);
  await browser.open(join(site, 'guide/index.html'));
  await browser.run(() => document.getElementById('menu-button').click());
  assert.ok((await seen(browser)).menu, 'the menu did not open');
  await browser.screenshot(join(shots, 'menu_400.png'));
  await browser.run(() => [...document.querySelectorAll('#menu a')].find((link) => link.textContent === 'Safety').click());
  await wait(browser, () => location.pathname.endsWith('safety.html'), 'a menu entry did not open its page');
  assert.ok(!(await seen(browser)).menu, 'the menu stayed open');
}

// Chromium saves the choice in the background and may lose it when the page is left at once, so the choice is made again until
// the next page has it.
async function checkTheme(browser) {
  await browser.resize(1366, 900);
  let chosen, next;
  for (let i = 1; i <= 20 && (i === 1 || next !== chosen); ++i) {
    await browser.open(join(site, 'index.html'));
    const before = (await seen(browser)).paper;
    await browser.run(() => document.getElementById('theme-button').click());
    chosen = (await seen(browser)).paper;
    assert.ok(Math.abs(chosen - before) > 0.7, `the button did not switch: ${before} to ${chosen}`);
    await sleep(200 * i);
    await browser.open(join(site, 'guide/index.html'));
    next = (await seen(browser)).paper;
  }
  assert.equal(next, chosen, 'the choice was forgotten on the next page');
  await browser.run(() => localStorage.clear());
}

const browser = await Browser.start({ width: 1366, height: 900 });
try {
  const layout = await Layout.of(browser);
  for (const page of named.length ? named : pages) {
    const looked = kLookedAt.includes(page);
    assert.deepEqual(await (looked ? layout.everywhere(join(site, page)) : layout.at(join(site, page), 400, 'light')), [], page);
    for (const width of kSizes) for (const theme of looked ? ['light', 'dark'] : ['light']) await look(browser, page, width, theme);
  }
  await checkTheme(browser);
  await checkMenuOfAPhone(browser);
  for (const width of [1366, 400]) await checkSearch(browser, width);
  console.log(`ok ${(named.length ? named : pages).length} pages at ${kSizes.join(', ')} pixels; screenshots in ${relative(process.cwd(), shots)}`);
} finally {
  await browser.stop();
}
