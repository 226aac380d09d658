#!/usr/bin/env node
// Golden verdicts: what `hop diagnose` answers on a list of campaigns before a change of its code, and after it.
//   tests/golden/golden.mjs keep HOP FOLDER [CAMPAIGN…]      makes the campaigns there and keeps the answers of HOP
//   tests/golden/golden.mjs compare HOP FOLDER [CAMPAIGN…]   answers of HOP on the same campaigns against those kept
// HOP is a built `hop`; FOLDER lies outside the repository. CAMPAIGN adds a folder of recordings to the list. Both verbs
// continue where they were stopped: delete FOLDER/other to compare with another build. `--only TEXT` takes the campaigns
// whose name holds TEXT. Exit status 1: an answer differs.
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';

import { json_differences, text_difference } from './differences.mjs';
import { cases } from './golden_cases.mjs';

const args = process.argv.slice(2);
const at = args.indexOf('--only');
const only = at < 0 ? '' : args.splice(at, 2)[1];
const [verb, program, work, ...others] = args;
if (!['keep', 'compare'].includes(verb) || !work) {
  console.error('usage: golden.mjs keep|compare HOP FOLDER [CAMPAIGN…] [--only TEXT]');
  process.exit(2);
}
const hop = resolve(program), folder = resolve(work);
const texts = ['said.txt', 'corrected.toml', 'diagnosis.html'];

function run(...words) {
  const done = spawnSync(hop, words, { encoding: 'utf8', maxBuffer: 1 << 28 });
  if (done.error || done.signal) throw done.error ?? new Error(`${words.join(' ')}: ended by ${done.signal}`);
  return done;
}

function made({ name, plant, kind, seed, trials }) {
  const target = join(folder, 'campaigns', name);
  if (existsSync(target)) return target;
  const whole = join(folder, 'making');
  rmSync(whole, { recursive: true, force: true });
  const done = run('conceal', '--output', whole, '--campaigns', '1', '--seed', `${seed}`, '--plant', plant, '--kind', kind,
    '--trials', `${trials}`);
  if (done.status !== 0) throw new Error(`hop conceal for ${name}: ${done.stderr}`);
  mkdirSync(join(folder, 'campaigns'), { recursive: true });
  renameSync(join(whole, 'campaigns/001'), target);
  return target;
}

function answered(name, campaign, target) {
  const place = join(folder, target, name);
  if (existsSync(place)) return place;
  const making = join(folder, target, 'making');
  rmSync(making, { recursive: true, force: true });
  mkdirSync(making, { recursive: true });
  const done = run('diagnose', campaign, '--output', making);
  writeFileSync(join(making, 'said.txt'), `exit status ${done.status}\n${done.stdout}`);
  renameSync(making, place);
  return place;
}

const text_of = file => (existsSync(file) ? readFileSync(file, 'utf8') : '');
const json_of = place => JSON.parse(text_of(join(place, 'diagnosis.json')) || 'null');

function differences(kept, other) {
  const found = json_differences(json_of(kept), json_of(other));
  for (const name of texts) {
    const difference = text_difference(text_of(join(kept, name)), text_of(join(other, name)));
    if (difference) found.push(`${name}: ${difference}`);
  }
  return found;
}

const list = [
  ...cases.map(one => ({ name: one.name, campaign: () => made(one) })),
  ...others.map(path => ({ name: resolve(path).split('/').slice(-2).join('+'), campaign: () => resolve(path) })),
].filter(({ name }) => name.includes(only));
let compared = 0, different = 0;
for (const { name, campaign } of list) {
  const kept = join(folder, 'kept', name);
  if (verb === 'keep') {
    const answer = json_of(answered(name, campaign(), 'kept'));
    console.log(`${name}: ${answer ? `${answer.verdict}, ${(answer.effects ?? []).map(effect => effect.id).join(' + ')}` : 'no answer'}`);
    continue;
  }
  if (!existsSync(kept)) {
    console.log(`${name}: no answer was kept`);
    continue;
  }
  const found = differences(kept, answered(name, campaign(), 'other'));
  compared += 1;
  if (found.length) different += 1;
  console.log(`${name}: ${found.length ? 'DIFFERS' : 'the same'}`);
  for (const line of found.slice(0, 5)) console.log(`    ${line}`);
}
if (verb === 'compare') {
  console.log(`${compared} compared, ${different} differ, of ${list.length}`);
  process.exit(different || compared < list.length ? 1 : 0);
}
