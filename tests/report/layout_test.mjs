// The checks of layout.mjs find what is planted in a page, and nothing in the same page without it.
//   node layout_test.mjs
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { Browser } from './browser.mjs';
import { Layout } from './layout.mjs';

const kGood = `<p>Some words that are easy to read.</p>
<figure><div class="legend">one line</div><svg viewBox="0 0 300 60" width="300" height="60"><text x="20" y="30">axis</text></svg></figure>`;

const kPlanted = [
  ['a page wider than the window', '<div style="width: 1500px">wide</div>', /pixels wider than the window/],
  ['a column behind a scroll bar', '<div style="overflow-x: auto; width: 200px"><div style="width: 400px">column</div></div>', /hides \d+ pixels of its width: column/],
  ['two texts on one another', '<p>below</p><p style="margin-top: -34px">above</p>', /'below' and 'above' overlap/],
  ['two labels of a figure on one another', '<svg viewBox="0 0 300 60" width="300" height="60"><text x="20" y="30">12.5</text><text x="30" y="32">13.0</text></svg>', /'12.5' and '13.0' overlap/],
  ['a label out of its figure', '<svg viewBox="0 0 300 60" width="300" height="60" style="overflow: visible"><text x="290" y="30">too long</text></svg>', /'too long' reaches out of its figure/],
  ['two texts of a canvas on one another', '<canvas id="c" width="300" height="60"></canvas><script>{ const c = document.getElementById("c").getContext("2d"); c.fillText("first", 20, 30); c.fillText("second", 25, 32); }</script>', /'first' and 'second' overlap/],
  ['a legend on its figure', '<figure style="position: relative"><svg viewBox="0 0 300 60" width="300" height="60"></svg><div class="legend" style="position: absolute; top: 5px; left: 5px">name</div></figure>', /a legend stands on its figure: name/],
  ['a name on its value', '<style>td::before { content: attr(data-name); float: left; width: 60px; white-space: nowrap }</style><table data-form="cards"><tr><td data-name="largest size of all">12</td></tr></table>', /'largest size of all' runs into its value '12'/],
  ['a broken word', '<p style="width: 3em; overflow-wrap: anywhere">compression</p>', /'compression' is broken over \d lines/],
  ['pale text', '<p style="color: #aaa">pale</p>', /'pale' has a contrast of 2\.\d/],
  ['text that is half transparent', '<p style="opacity: .4">faded</p>', /'faded' has a contrast of/],
];

const folder = mkdtempSync(join(tmpdir(), 'sandhopper-layout-'));
const file = join(folder, 'page.html');
const browser = await Browser.start({ width: 1366, height: 768 });
try {
  const layout = await Layout.of(browser);
  const faultsOf = async (body) => {
    writeFileSync(file, `<!doctype html><meta charset="utf-8"><body style="background: #fff; color: #222">${kGood}${body}`);
    return layout.at(file, 1366, 'light');
  };
  assert.deepEqual(await faultsOf(''), []);
  for (const [name, body, wanted] of kPlanted) {
    const faults = await faultsOf(body);
    assert.ok(faults.some((fault) => wanted.test(fault)), `${name} was not found: ${faults.join('; ')}`);
    console.log(`ok ${name}`);
  }
} finally {
  await browser.stop();
  rmSync(folder, { recursive: true });
}
