#!/usr/bin/env node
// `hop diagnose` as a new user runs it. The same campaigns renamed, shuffled, on another clock and at another rate
// must give the same verdict, and parameters within their intervals. A foreign folder with its own column names,
// half of its channels and one broken file must get an answer that names the missing channels and the broken file.
//   tests/cli/diagnose.mjs [BUILD-DIRECTORY]
import { spawnSync } from 'node:child_process';
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

import { file_of, join_trials, parse, print, rewritings, split_trials } from './diagnose_cases.mjs';

const root = resolve(dirname(fileURLToPath(import.meta.url)), '../..');
const hop = join(resolve(process.argv[2] ?? join(root, 'build')), 'bin/hop');
const scratch = mkdtempSync(join(tmpdir(), 'hop-diagnose-'));
const run = (...args) => spawnSync(hop, args, { encoding: 'utf8', timeout: 280000, maxBuffer: 1 << 28 });
let failed = 0;
function expect(right, text) {
  if (right) return;
  failed += 1;
  console.log(`      WRONG: ${text}`);
}
const answer = (folder, name) => {
  const done = run('diagnose', folder, '--output', join(scratch, `answer-${name}`), '--json');
  expect(done.status === 0, `${name}: exit ${done.status}: ${done.stderr.slice(-300)}`);
  return { ...JSON.parse(done.stdout || '{}'), said: done.stderr };
};
const named = diagnosis => (diagnosis.effects ?? []).map(effect => effect.id).sort().join(' + ') || 'nothing';

// Concealed campaigns; the hidden effect is large enough to be certain.
const made = [
  { plant: 'falling_body', effect: 'air.quadratic_drag', seed: '11' },
  { plant: 'intruder', effect: 'terrain.depth_power_law', seed: '13' },
].map(one => {
  const folder = join(scratch, one.plant);
  const done = run('conceal', '--output', folder, '--campaigns', '1', '--seed', one.seed, '--plant', one.plant,
    '--effect', one.effect, '--size', '1.5', '--trials', '4');
  expect(done.status === 0, `hop conceal for ${one.plant}: ${done.stderr}`);
  return { ...one, folder: join(folder, 'campaigns/001') };
});

function rewritten(source, one, target) {
  cpSync(source, target, { recursive: true });
  const toml = split_trials(readFileSync(join(source, 'campaign.toml'), 'utf8'));
  toml.trials = toml.trials.map((trial, i) => {
    const from = file_of(trial);
    const to = one.rename ? one.rename(from, i) : from;
    const table = parse(readFileSync(join(source, from), 'utf8'));
    if (to !== from) rmSync(join(target, from));
    mkdirSync(dirname(join(target, to)), { recursive: true });
    writeFileSync(join(target, to), print(one.table ? one.table(table) : table));
    return trial.replace(from, to);
  });
  if (one.trials) toml.trials = one.trials(toml.trials);
  writeFileSync(join(target, 'campaign.toml'), join_trials(toml));
}

// With the corrected model of the first run, beside its recordings: nothing may be missing, and the model
// must not change.
function second_run({ plant, folder }) {
  const target = join(scratch, `second-${plant}`);
  cpSync(folder, target, { recursive: true });
  const corrected = readFileSync(join(scratch, `answer-${plant}`, 'corrected.toml'), 'utf8');
  writeFileSync(join(target, 'corrected.toml'), corrected);
  const own = new Set(readFileSync(join(target, 'nominal.toml'), 'utf8').split('\n'));
  const others = corrected.split('\n').filter(line => !own.has(line) && !/found by hop diagnose|^#|^\[/.test(line));
  expect(!others.length, `${plant}: corrected.toml states what nobody stated: ${others.slice(0, 3).join('; ')}`);
  const toml = readFileSync(join(target, 'campaign.toml'), 'utf8').replace(/^model *= *".*"$/m, 'model = "corrected.toml"');
  expect(toml.includes('model = "corrected.toml"'), `${plant}: campaign.toml names no model`);
  writeFileSync(join(target, 'campaign.toml'), toml);
  const done = run('diagnose', target, '--json', '--no-report');
  const again = JSON.parse(done.stdout || '{}');
  console.log(`    on the corrected model: ${again.verdict}, ${named(again)}`);
  expect(again.verdict === 'consistent', `${plant} on its corrected model: ${again.verdict}, ${named(again)}`);
  expect(readFileSync(join(target, 'corrected.toml'), 'utf8') === corrected, `${plant}: the model in use was overwritten`);
}

// A run on the corrected model reads these entries of the first answer; and the list of effects holds those that were found.
function first_answer({ plant, folder }) {
  const first = join(scratch, `answer-${plant}`);
  const said = JSON.parse(readFileSync(join(first, 'diagnosis.json'), 'utf8'));
  expect(said.corrected_model === 'corrected.toml', `${plant}: diagnosis.json names no corrected model`);
  expect(said.fit.heldout.beyond_floor.before > 0, `${plant}: no error beyond the noise floor`);
  const toml = readFileSync(join(folder, 'campaign.toml'), 'utf8').replace(/^model *= *".*"$/m, `model = "${join(first, 'corrected.toml')}"`);
  writeFileSync(join(folder, 'again.toml'), toml);
  const again = JSON.parse(run('diagnose', join(folder, 'again.toml'), '--output', join(scratch, `again-${plant}`), '--json', '--no-report').stdout || '{}');
  rmSync(join(folder, 'again.toml'));
  expect(again.first_answer === join(first, 'diagnosis.json'), `${plant}: the run on the corrected model read ${again.first_answer}`);
  expect(said.first_answer === null, `${plant}: a first run names a run before it`);
  const listed = JSON.parse(run('diagnose', folder, '--effects', '--json').stdout || '{}').effects ?? [];
  for (const effect of said.effects)
    expect(listed.some(one => one.id === effect.id && one.parameters.length), `${plant}: --effects does not list ${effect.id}`);
}

for (const campaign of made) {
  const plain = answer(campaign.folder, campaign.plant);
  console.log(`${campaign.plant}: ${plain.verdict}, ${named(plain)}`);
  expect(plain.verdict === 'missing_physics', `${campaign.plant}: ${plain.verdict}`);
  second_run(campaign);
  first_answer(campaign);
  for (const one of rewritings) {
    const target = join(scratch, `${campaign.plant}-${one.name.replace(/\W+/g, '_')}`);
    rewritten(campaign.folder, one, target);
    const again = answer(target, `${campaign.plant}-${one.name.replace(/\W+/g, '_')}`);
    console.log(`    ${one.name}: ${again.verdict}, ${named(again)}`);
    expect(again.verdict === plain.verdict && named(again) === named(plain), `${campaign.plant} ${one.name}: another answer`);
    for (const effect of plain.effects ?? []) {
      const other = again.effects?.find(e => e.id === effect.id);
      if (!other) continue;
      for (const [name, { value }] of Object.entries(effect.parameters)) {
        const [low, high] = other.parameters[name].ci95;
        expect(low <= value && value <= high, `${campaign.plant} ${one.name}: ${name} ${value} is not within ${low} to ${high}`);
      }
    }
  }
}

// A foreign folder: other column names and units, no speed and acceleration, and one file that is no table.
const source = made.find(one => one.plant === 'intruder').folder;
const foreign = join(scratch, 'foreign');
cpSync(source, foreign, { recursive: true });
const toml = split_trials(readFileSync(join(source, 'campaign.toml'), 'utf8'));
const broken = file_of(toml.trials[1]);
for (const trial of toml.trials) {
  const file = join(foreign, file_of(trial));
  const table = parse(readFileSync(file, 'utf8'));
  const [t, z, f] = ['t_s', 'foot_z_m', 'force_N'].map(name => table.header.indexOf(name));
  writeFileSync(file, print({ header: ['Time', 'Depth mm', 'Load'],
    rows: table.rows.map(row => [row[t], row[z] === '' ? '' : String(-1000 * Number(row[z])), row[f]]) }));
}
writeFileSync(join(foreign, broken), 'this is not\na table of anything\n');
writeFileSync(join(foreign, 'campaign.toml'), join_trials({ ...toml, head: `${toml.head.replace(/\[columns\][^[]*/, '')}
[columns]
t_s = "Time"
foot_z_m = { column = "Depth mm", scale = -0.001 }
force_N = "Load"

` }));
const told = answer(foreign, 'foreign');
console.log(`foreign: ${told.verdict}, ${named(told)}`);
expect(told.said.includes(broken), 'the broken file is not named');
expect(told.verdict === 'missing_physics' && named(told).includes('terrain.depth_power_law'), 'half of the channels hold the same effect');

rmSync(scratch, { recursive: true, force: true });
console.log(failed ? `${failed} wrong` : 'all as it should be');
process.exit(failed ? 1 : 0);
