#!/usr/bin/env node
// Rules for every verb of `hop`: help exits with 0, wrong options exit with 2, and --json prints one object on standard
// output. Then the keys of the objects of trial and replay that other programs read.
//   tests/cli/verbs.mjs [BUILD-DIRECTORY]
import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = resolve(dirname(fileURLToPath(import.meta.url)), '../..');
const hop = join(resolve(process.argv[2] ?? join(root, 'build')), 'bin/hop');
const run = (...args) => spawnSync(hop, args, { encoding: 'utf8', timeout: 20000 });

let failed = 0;
function expect(right, text) {
  if (right) return;
  failed += 1;
  console.log(`WRONG: ${text}`);
}
function is_one_object(text) {
  try {
    const value = JSON.parse(text);
    return typeof value === 'object' && value !== null && !Array.isArray(value);
  } catch {
    return false;
  }
}

expect(/^hop \d+\.\d+\.\d+/.test(run('--version').stdout), 'hop --version');
const help = run('--help');
expect(help.status === 0, 'hop --help exits with 0');
const lines = help.stdout.split('Verbs:\n')[1].split('\n\n')[0].split('\n');
for (const line of lines) {
  const [verb, ...summary] = line.trim().split(/\s+/);
  console.log(`hop ${verb}: ${summary.join(' ')}`);
  expect(summary.length > 2, `${verb} has a one-line summary`);

  const own = run(verb, '--help');
  expect(own.status === 0 && own.stdout.includes(`Usage: hop ${verb}`), `hop ${verb} --help`);
  expect(own.stdout.includes('--json') && own.stdout.includes('--config'), `hop ${verb} takes --json and --config`);
  const own_json = run(verb, '--help', '--json');
  expect(own_json.status === 0 && is_one_object(own_json.stdout), `hop ${verb} --help --json is one object`);

  const wrong = run(verb, '--no-such-option');
  expect(wrong.status === 2 && wrong.stdout === '' && wrong.stderr.includes("unknown option '--no-such-option'"),
    `hop ${verb} --no-such-option exits with 2 and says so`);
  const wrong_json = run(verb, '--no-such-option', '--json');
  expect(wrong_json.status === 2 && is_one_object(wrong_json.stdout), `hop ${verb} --no-such-option --json is one object`);
}

const check = run('config', 'check', '--json');
expect(check.status === 0 && is_one_object(check.stdout), 'hop config check --json: the files as they are, are right');
const show = run('config', 'show', '--json');
expect(show.status === 0 && Object.values(JSON.parse(show.stdout))[2].motor.length === 2, 'hop config show --json');
const folder = mkdtempSync(join(tmpdir(), 'hop-verbs-'));
const trial = run('trial', '--json', '--strides', '1', '--output', folder);
expect(trial.status === 0 && is_one_object(trial.stdout), 'hop trial --json');
const told = JSON.parse(trial.stdout);
expect(told.strides.length === 1 && told.strides[0].touchdown_speed_mps > 0.5, 'strides[].touchdown_speed_mps');
for (const treatment of ['qs_ols', 'mo_ols', 'mo_wls', 'joint']) {
  const { value, ci95, valid } = told.strides[0].stiffness_N_per_m[treatment];
  expect(typeof value === 'number' && ci95.length === 2 && typeof valid === 'boolean',
    `strides[].stiffness_N_per_m.${treatment}.{value,ci95,valid}`);
}
expect(existsSync(told.log) && existsSync(told.report), 'log and report are there');
expect(/stride 1: touchdown/.test(trial.stderr), 'the text goes to standard error');

const replay = run('replay', told.log, '--json');
expect(replay.status === 0 && is_one_object(replay.stdout), 'hop replay --json');
const { identical, cycles, x_real_time } = JSON.parse(replay.stdout);
expect(identical === true && cycles > 1000 && x_real_time > 1, 'identical, cycles, x_real_time');

// A log cut in the middle: the readable part becomes a log again, and the cut log does not change.
const cut = told.log.replace('.mcap', '_cut.mcap');
const half = readFileSync(told.log).subarray(0, Math.floor(statSync(told.log).size / 2));
writeFileSync(cut, half);
const recover = run('recover', cut, '--json');
expect(recover.status === 0 && is_one_object(recover.stdout), 'hop recover --json');
const recovered = JSON.parse(recover.stdout);
expect(recovered.whole === false && recovered.cut_at_byte <= half.length && recovered.saved > 100,
  'whole, cut_at_byte, saved');
expect(recovered.lost === null && recovered.lost_at_least === 0 && recovered.cycles.missing_at_end === null && recovered.cycles.missing_inside === 0,
  'nobody knows what the cut took: lost is null');
expect(readFileSync(cut).equals(half), 'the cut log is left alone');
const replay_of_half = run('replay', recovered.output, '--json');
expect(replay_of_half.status === 0 && JSON.parse(replay_of_half.stdout).identical === true, 'the recovered log replays');
expect(run('recover', cut, '--json').status === 2, 'what was recovered is not overwritten');
const whole = run('recover', told.log, '--json');
expect(whole.status === 0 && JSON.parse(whole.stdout).whole === true && JSON.parse(whole.stdout).output === null,
  'a whole log is said to be whole');
expect(run('recover', told.report, '--json').status === 1, 'a file that is no log: exit 1');
rmSync(folder, { recursive: true });

console.log(failed === 0 ? `${lines.length} verbs: all right` : `${failed} wrong`);
process.exit(failed === 0 ? 0 : 1);
