// The tables of the documentation's page from benchmarks of one plant each, as Markdown.
//   node tools/benchmark/page.mjs FOLDER…        folders of `hop conceal benchmark`, each with its score.json
import fs from 'node:fs';
import path from 'node:path';

const folders = process.argv.slice(2);
if (folders.length === 0) {
  console.error('usage: node tools/benchmark/page.mjs FOLDER…   (folders with a score.json)');
  process.exit(2);
}
const plants = folders.map((folder) => {
  const { tools, splits } = JSON.parse(fs.readFileSync(path.join(folder, 'score.json'), 'utf8'));
  return { name: tools['hop diagnose'].cases[0].plant.replace('_', ' '), tools, splits, own: tools['hop diagnose'] };
});

const percent = (share) => (100 * share).toFixed(1);
const row = (cells) => `| ${cells.join(' | ')} |`;
const table = (head, rows) => [row(head), row(head.map(() => '---')), ...rows.map(row), ''].join('\n');
const capital = (text) => text[0].toUpperCase() + text.slice(1);

// Wilson, J. Am. Stat. Assoc. 22, 1927
function wilson95(count, of) {
  const z = 1.959964, centre = count + z * z / 2, half = z * Math.sqrt(count * (of - count) / of + z * z / 4);
  return [(centre - half) / (of + z * z), (centre + half) / (of + z * z)];
}

function shown({ count, of }, { must, less_is_better }, asked) {
  if (of === 0) return 'none';
  const [low, high] = wilson95(count, of), share = count / of;
  const met = !asked || (less_is_better ? share <= must : share >= must);
  return `${percent(share)} (${percent(low)} to ${percent(high)}) of ${of}${met ? '' : ', **missed**'}`;
}

const sum = (values) => values.reduce((total, value) => total + value, 0);

// As for one plant, the claims of all in the same ten bins: mean distance of probability and share that is right.
function calibrationErrorOfAll() {
  const bins = new Map();
  for (const { own } of plants)
    for (const { from, count, mean_probability, share_right } of own.reliability) {
      const bin = bins.get(from) ?? { count: 0, apart: 0 };
      bins.set(from, { count: bin.count + count, apart: bin.apart + count * (share_right - mean_probability) });
    }
  const all = [...bins.values()];
  return sum(all.map((bin) => Math.abs(bin.apart))) / sum(all.map((bin) => bin.count));
}

// One row: each plant's, and all of them together.
function figureRow(ofPlants) {
  const known = ofPlants.filter((f) => f !== undefined);
  const asked = !/control/.test(known[0].figure);
  const all = { count: sum(known.map((f) => f.count)), of: sum(known.map((f) => f.of)) };
  const { figure, must, less_is_better } = known[0];
  return [figure, asked ? `${less_is_better ? 'at most' : 'at least'} ${100 * must}` : '',
    ...ofPlants.map((f) => (f === undefined ? 'not asked' : shown(f, known[0], asked))), shown(all, known[0], asked)];
}

// One row of the localisation: `value` of the counted cells of each plant, and of all plants together.
function localisationRow(name, must, value) {
  const known = plants.map((plant) => plant.own.localisation).filter((l) => l?.campaigns > 0);
  const all = Object.fromEntries(['campaigns', 'true_positives', 'false_positives', 'missed'].map((key) => [key, sum(known.map((l) => l[key]))]));
  const cell = (l) => {
    if (!l?.campaigns) return 'not measured';
    const share = value(l);
    return Number.isNaN(share) ? 'none reported' : `${percent(share)} in ${l.campaigns}${must && share < must ? ', **missed**' : ''}`;
  };
  return [name, must ? `at least ${100 * must}` : '', ...plants.map((plant) => cell(plant.own.localisation)), cell(all)];
}

const figures = plants[0].own.figures.map((_, i) => figureRow(plants.map((plant) => plant.own.figures[i])));
for (const { figure } of plants.find((plant) => plant.splits?.length)?.splits ?? [])
  figures.push(figureRow(plants.map((plant) => plant.splits?.find((f) => f.figure === figure))));
figures.push(localisationRow('localisation: precision', 0, (l) => l.true_positives / (l.true_positives + l.false_positives)));
figures.push(localisationRow('localisation: recall', 0, (l) => l.true_positives / (l.true_positives + l.missed)));
figures.push(localisationRow('localisation: F1', 0.75, (l) => 2 * l.true_positives / (2 * l.true_positives + l.false_positives + l.missed)));
const named = plants.map((p) => p.own.figures[1].count);
figures.push(['mean class size of the right names', 'at most 2.5', ...plants.map((p) => p.own.mean_class_size.toFixed(2)),
  (sum(plants.map((p, i) => p.own.mean_class_size * named[i])) / sum(named)).toFixed(2)]);
figures.push(['expected calibration error', 'at most 0.05', ...plants.map((p) => p.own.expected_calibration_error.toFixed(3)),
  calibrationErrorOfAll().toFixed(3)]);
console.log(table(['figure', 'must', ...plants.map((p) => p.name), 'all'], figures));

console.log('The same campaigns through plainer methods: false alarms, right names, confident wrong names.\n');
const plainer = Object.keys(plants[0].tools).filter((name) => name !== 'hop diagnose');
console.log(table(['method', ...plants.map((p) => p.name)],
  plainer.map((name) => [name, ...plants.map((p) => p.tools[name].figures.slice(0, 3).map((f) => percent(f.value ?? 0)).join(', '))])));

console.log('## By size\nSingle effects, relative to their typical size: campaigns, noticed, right, confident wrong.\n');
console.log(table(['size', ...plants.map((p) => p.name)],
  plants[0].own.size_ladder.map((step, i) => [`${step.from} to ${Math.floor(100 * step.to) / 100}`,
    ...plants.map((p) => { const s = p.own.size_ladder[i]; return [s.cases, s.noticed, s.right, s.confident_wrong].join(', '); })])));

for (const plant of plants) {
  console.log(`## ${capital(plant.name)}, by effect\nCampaigns in which it is the only thing hidden.\n`);
  console.log(table(['effect', 'campaigns', 'right alone', 'right in a class', 'unknown', 'nothing missing', 'no answer', 'other names'],
    Object.entries(plant.own.by_effect ?? {}).map(([id, f]) => [`\`${id}\``, f.cases, f.right_alone, f.right_in_class, f.unknown, f.nothing_missing,
      f.no_answer, Object.entries(f.other_names ?? {}).map(([name, count]) => `\`${name}\` ${count}`).join(', ')])));
  console.log(`### ${capital(plant.name)}: every campaign that was not right`);
  console.log('A number after a name is its probability; = stands before what it cannot be told from.\n');
  console.log(table(['campaign', 'kind', 'hidden (times typical)', 'said'],
    plant.own.cases.filter((c) => !c.right).map((c) => [c.campaign, c.kind,
      c.hidden.map((e) => `\`${e.id}\` ${Number(e.size_relative.toPrecision(2))}`).join(', '), c.said])));
}
