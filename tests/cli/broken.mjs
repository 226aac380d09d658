#!/usr/bin/env node
// Runs `hop` on every broken configuration and command line of cases.mjs, plain and with --json, and prints case, exit
// status and message. Each must exit with 2, say what is wrong and what to do, print nothing else and leave nothing
// behind. So must hopperd with every broken configuration.
//   tests/cli/broken.mjs [BUILD-DIRECTORY]
import { spawnSync } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync, mkdirSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

import { commands, configurations } from './cases.mjs';

const root = resolve(dirname(fileURLToPath(import.meta.url)), '../..');
const programs = join(resolve(process.argv[2] ?? join(root, 'build')), 'bin');
const scratch = mkdtempSync(join(tmpdir(), 'hop-broken-'));
const { SANDHOPPER_CONFIG, ...environment } = process.env;

function run(args, program = 'hop') {
  const cwd = join(scratch, 'cwd');
  rmSync(cwd, { recursive: true, force: true });
  mkdirSync(cwd);
  const done = spawnSync(join(programs, program), args, { cwd, env: environment, encoding: 'utf8', timeout: 20000 });
  return { ...done, left: readdirSync(cwd) };
}

// The command that would start something with this file.
const starting = (file) => (file === 'linux.toml' ? ['trial', '--board', 'linux'] : ['trial']);

function break_configuration({ name, file, from, to }) {
  const config = join(scratch, name.replaceAll(' ', '_'));
  cpSync(join(root, 'config'), config, { recursive: true, filter: (path) => !/\.[ch]pp$/.test(path) });
  if (from === null) {
    rmSync(join(config, file));
    return config;
  }
  const before = readFileSync(join(config, file), 'utf8');
  const after = before.replace(from, to);
  if (after === before) throw new Error(`${name}: ${file} does not hold ${from}`);
  writeFileSync(join(config, file), after);
  return config;
}

function faults_of({ says }, plain, json) {
  const faults = [];
  const expect = (right, text) => right || faults.push(text);
  expect(plain.status === 2, `exit ${plain.status ?? plain.signal}, not 2`);
  for (const text of says) expect(plain.stderr.includes(text), `does not say: ${text}`);
  expect(plain.stdout === '', 'prints to standard output');
  expect(plain.left.length === 0 && json.left.length === 0, `leaves behind ${plain.left} ${json.left}`);
  expect(json.status === 2, `--json: exit ${json.status}`);
  try {
    const { error } = JSON.parse(json.stdout);
    expect(error.exit === 2, '--json: no exit');
    const told = `${error.message}\n${error.cure}`;
    for (const text of says) expect(told.includes(text), `--json: does not say: ${text}`);
  } catch (error) {
    faults.push(`--json: ${error.message}`);
  }
  return faults;
}

function faults_of_daemon({ says, file, directory }) {
  const board = file === 'linux.toml' ? 'linux' : 'sim';
  const daemon = run(['--board', board, '--config', directory], 'hopperd');
  const faults = [];
  if (daemon.status !== 2) faults.push(`hopperd: exit ${daemon.status ?? daemon.signal}`);
  if (daemon.left.length > 0) faults.push(`hopperd leaves behind ${daemon.left}`);
  const told = JSON.parse(daemon.stdout).error;
  for (const text of says) if (!told.includes(text)) faults.push(`hopperd does not say: ${text}`);
  return faults;
}

const cases = [
  ...configurations.map((c) => {
    const directory = break_configuration(c);
    return { ...c, directory, args: [...starting(c.file), '--config', directory] };
  }),
  ...commands,
];
let failed = 0;
for (const [index, one] of cases.entries()) {
  const plain = run(one.args);
  const faults = faults_of(one, plain, run([...one.args, '--json']));
  if (one.directory) faults.push(...faults_of_daemon(one));
  failed += faults.length > 0 ? 1 : 0;
  const shown = plain.stderr.trim().replaceAll(`${scratch}/`, '').split('\n').map((line) => `      ${line}`).join('\n');
  const args = one.args.join(' ').replaceAll(`${scratch}/`, '');
  console.log(`${String(index + 1).padStart(2)}  exit ${plain.status}  ${one.name}: hop ${args}\n${shown}`);
  for (const fault of faults) console.log(`      WRONG: ${fault}`);
}
rmSync(scratch, { recursive: true });
console.log(`${cases.length - failed} of ${cases.length} broken configurations and command lines: clear error, cure, exit 2, nothing started`);
process.exit(failed === 0 ? 0 : 1);
