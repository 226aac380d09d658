#!/usr/bin/env node
// A campaign of simulated hops with one recording broken in each way there is: `hop terrain` and `hop campaign check`
// must name file, line and column and the cure, leave out no more than necessary, and analyse the rest to the same
// numbers. Then the campaign in parts, merged, against the whole.
//   tests/cli/campaign.mjs [BUILD-DIRECTORY]
import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

import { breakages } from './campaign_cases.mjs';

const root = resolve(dirname(fileURLToPath(import.meta.url)), '../..');
const hop = join(resolve(process.argv[2] ?? join(root, 'build')), 'bin/hop');
const scratch = mkdtempSync(join(tmpdir(), 'hop-campaign-'));
const run = (...args) => spawnSync(hop, args, { encoding: 'utf8', timeout: 60000, maxBuffer: 1 << 28 });
let failed = 0;
function expect(right, text) {
  if (right) return;
  failed += 1;
  console.log(`      WRONG: ${text}`);
}

const sound = join(scratch, 'sound');
expect(run('campaign', 'make', '--output', sound, '--trials', '6').status === 0, 'hop campaign make');
expect(run('campaign', 'check', sound).status === 0, 'a sound campaign has nothing to complain about');
expect(!run('campaign', 'check', sound).stdout.includes('usable, without'), 'and no channel is missing');
const whole = JSON.parse(run('terrain', sound, '--json', '--no-report').stdout);
expect(whole.usable_trials === 6, 'all six sound trials can be used');

// The third trial is broken; the results of the other five must not change.
const kBroken = 2;
for (const [index, one] of breakages.entries()) {
  const folder = join(scratch, `broken${index}`);
  cpSync(sound, folder, { recursive: true });
  const campaign = join(folder, 'campaign.toml');
  const file = join(folder, 'trials/0003.csv');
  if (one.recording) {
    const rows = readFileSync(file, 'utf8').trimEnd().split('\n');
    const changed = one.recording(rows);
    if (changed === null) rmSync(file);
    else writeFileSync(file, changed.length ? `${changed.join('\n')}\n` : '');
  }
  if (one.campaign) writeFileSync(campaign, one.campaign(readFileSync(campaign, 'utf8')));

  const done = run('terrain', folder, '--no-report');
  const place = `${one.in_campaign ? campaign : file}${one.place ? `:${one.place}` : ''}:`;
  const said = done.stdout.split('\n').find(line => line.includes(place) && one.says.every(text => line.includes(text)));
  console.log(`${String(index + 1).padStart(2)}  ${one.name}\n      ${(said ?? done.stdout + done.stderr).trim().replaceAll(`${folder}/`, '')}`);
  expect(done.status === 0, `exit ${done.status}`);
  expect(said, `does not say ${place} … ${one.says.join(' … ')}`);

  const told = JSON.parse(run('terrain', folder, '--json', '--no-report').stdout);
  expect(told.usable_trials === (one.usable ? 6 : 5), `${told.usable_trials} trials are used`);
  const others = trials => JSON.stringify(trials.filter(trial => trial.trial !== 'trials/0003.csv').map(({ trial, quantities }) => ({ trial, quantities })));
  expect(others(told.trials) === others(whole.trials), 'the other five trials say something else now');
  expect(told.conclusions.hops.joint_pooled.strides >= 3, 'nothing is concluded from the other five');
  if (one.keeps) {
    const broken = told.trials.find(trial => trial.index === kBroken);
    expect(one.keeps(broken), `of the broken trial less is left than should be: ${broken.ruled_out}`);
  }
  const findings = JSON.parse(run('campaign', 'check', folder, '--json').stdout).findings;
  if (one.without) {
    const last = run('campaign', 'check', folder).stdout.trimEnd().split('\n').at(-1);
    expect(last.endsWith(`6 usable, without ${one.without} in 1 trial`), `the last line is "${last}"`);
  }
  expect(findings.some(f => one.kinds.includes(f.kind) && f.cure), `hop campaign check finds ${findings.map(f => f.kind)}`);
}

// Parts and the whole, in files.
const parts = [1, 2, 3, 4].map(part => {
  const out = join(scratch, `part${part}`);
  expect(run('terrain', sound, '--part', `${part}/4`, '--output', out, '--no-report').status === 0, `part ${part}`);
  return join(out, `terrain_part_${part}_of_4.json`);
});
const merged = JSON.parse(run('terrain', '--merge', ...parts, '--json', '--output', join(scratch, 'merged')).stdout);
for (const key of ['trials', 'pooled', 'conclusions']) {
  expect(JSON.stringify(merged[key]) === JSON.stringify(whole[key]), `four parts merged differ from the whole in ${key}`);
}
const incomplete = run('terrain', '--merge', ...parts.slice(1), '--output', join(scratch, 'merged'));
expect(incomplete.status === 2 && incomplete.stderr.includes('trial 1 of the campaign is in none of the parts'), 'a part left out is noticed');
const refused = run('terrain', join(scratch, 'merged'));
expect(refused.status === 2 && refused.stderr.includes('campaign.toml'), 'a folder that is no campaign is refused');
expect(refused.stderr.includes('hop campaign keys PLANT'), 'what explains a campaign is named, not the configuration of the robot');

// An import writes both of its files or none.
const half = join(scratch, 'half');
mkdirSync(half);
writeFileSync(join(half, 'nominal.toml'), '# mine\n');
const imported = run('campaign', 'import', join(sound, 'trials/0001.csv'), '--output', half);
expect(imported.status === 2 && imported.stderr.includes('nominal.toml exists already'), 'a model that is there is not overwritten');
expect(!existsSync(join(half, 'campaign.toml')), 'and no campaign.toml is left beside it');

// An import that cannot be right does not end as if it were.
const table = (name, header) => {
  const file = join(scratch, name);
  writeFileSync(file, `${header}\n${Array.from({ length: 20 }, (_, i) => `${i},${2 * i},${3 * i}`).join('\n')}\n`);
  return file;
};
const unclear = run('campaign', 'import', table('unclear.csv', 't,x,y'), '--output', join(scratch, 'unclear'));
expect(unclear.status === 2 && unclear.stdout.includes('"x": no unit, first value 0'), 'the columns of an unclear table are shown');
expect(/go on with 'hop campaign import \S+unclear.csv --plant PLANT'/.test(unclear.stderr), 'the command to go on is given');
const timeless = run('campaign', 'import', table('timeless.csv', 'a,b,angle'), '--output', join(scratch, 'timeless'));
expect(timeless.status === 1 && timeless.stdout.includes('wrong: no column is a time'), 'a table without a time ends with status 1');

// Limits of time, and wrong arguments.
const limited = run('diagnose', sound, '--limit-s', '0', '--no-report', '--json', '--output', join(scratch, 'limited'));
expect(limited.status === 1 && JSON.parse(limited.stdout).verdict === 'insufficient_time', 'a limit of no time at all is said');
expect(run('diagnose', sound, '--limit-s', '-1').status === 2, 'a negative limit is refused');

rmSync(scratch, { recursive: true });
console.log(`${breakages.length} kinds of broken recordings, ${failed} faults`);
process.exit(failed === 0 ? 0 : 1);
