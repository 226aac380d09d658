// The commands that README and guide tell people to type, in a fresh copy of what is committed: every script exists, every
// option is one the program knows, and each block is run, in the order in which it is read. What needs root, the robot, a
// placeholder filled in or more than a quarter of an hour is not run; it is listed with the reason.
//   node commands.mjs BUILD_FOLDER [PAGE.md…]        default: README.md and every page of the guide
import { execFileSync, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

const root = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), '../..');
const hop = path.join(path.resolve(process.argv[2]), 'bin/hop');
const guide = fs.readdirSync(path.join(root, 'tools/docs/guide')).filter((name) => name.endsWith('.md'));
const pages = process.argv.length > 3 ? process.argv.slice(3)
  : ['README.md', ...guide.sort().map((name) => `tools/docs/guide/${name}`)];

// Reasons why a command is not run here; the first that matches counts.
const reasons = [
  [/^sudo |\bapt-get\b|\badduser\b|^ip link|\bdd if=|\breboot\b|tools\/(image|package)\/build|clean_machine/, 'needs root'],
  [/tools\/bench\b/, 'boots the virtual bench: ctest -L bench'],
  [/--board linux|\bhop doctor\b|\bhop calibrate (?!.*--(board sim|from))/, 'needs the robot'],
  [/^ssh |robot\.local/, 'needs the robot'],
  [/\bhop conceal benchmark\b|tools\/benchmark\/page\.mjs/, 'takes hours'],
  [/tests\/fuzz\/|tools\/test\b|tools\/build\b|tools\/lint\b/, 'takes more than a quarter of an hour, or is the test itself'],
  [/\bhop replay --can (my_trace\.log|TRACE\.candump)/, 'needs a trace of your own'],
  [/\bother\.csv\b|\btaps\.mcap\b/, 'needs recordings of your own'],
  [/ config\/campaigns\//, 'needs recordings that are not part of the source; docs.ready_campaigns looks at what is said then'],
  [/\b(COMMAND|CODE|FOLDER)\b/, 'has a placeholder'],
];
const reasonNotToRun = (command) => reasons.find(([pattern]) => pattern.test(command))?.[1];

const problems = [];
const environment = { ...process.env, SANDHOPPER_NO_BUILD: '1' };
delete environment.SANDHOPPER_CONFIG;
delete environment.SANDHOPPER_DATA;

// A folder with the committed files (with changes to them), and nothing else; no `shared` folder beside it.
const work = fs.mkdtempSync(path.join(os.tmpdir(), 'hop-docs-'));
const clone = path.join(work, 'clone');
fs.mkdirSync(clone);
for (const file of execFileSync('git', ['ls-files', '-z'], { cwd: root, encoding: 'utf8', maxBuffer: 1 << 26 }).split('\0')) {
  if (!file || !fs.existsSync(path.join(root, file))) continue;
  fs.mkdirSync(path.dirname(path.join(clone, file)), { recursive: true });
  fs.copyFileSync(path.join(root, file), path.join(clone, file));
}

// Wrappers for `hop` and the copy's tools/hop that start the built programs and record what was run. Exit
// status 1 is an answer ("no") except for a replay.
const ran = path.join(work, 'ran');
fs.writeFileSync(ran, '');
const wrapper = `#!/bin/bash
SANDHOPPER_CONFIG=\${SANDHOPPER_CONFIG:-${clone}/config} "${hop}" "$@"
status=$?
echo "$status hop $*" >> "${ran}"
[[ $status == 1 && $1 != replay ]] && status=0
exit $status
`;
fs.mkdirSync(path.join(work, 'bin'));
for (const place of [path.join(clone, 'tools/hop'), path.join(work, 'bin/hop')]) fs.writeFileSync(place, wrapper, { mode: 0o755 });
environment.PATH = `${path.join(work, 'bin')}:${environment.PATH}`;

const helps = new Map();
function help(words) {
  const key = words.join(' ');
  if (!helps.has(key)) helps.set(key, spawnSync(hop, [...words, '--help'], { encoding: 'utf8' }));
  return helps.get(key);
}

// "hop VERB [PART]": as many words as the program takes for verbs.
function verbWords(words) {
  let taken = [];
  for (const word of words) {
    if (!/^[a-z-]+$/.test(word) || word.startsWith('-')) break;
    const known = help(taken).stdout.split('Verbs:')[1]?.match(new RegExp(`^  ${word}\\s`, 'm'));
    if (!known) break;
    taken = [...taken, word];
  }
  return taken;
}

function checkCommand(where, command) {
  const words = (command.match(/"[^"]*"|\S+/g) ?? []).map((word) => word.replaceAll('"', '')).filter((word) => word !== 'sudo');
  for (const word of words.slice(0, 2))
    if (/^(tools|tests)\//.test(word) && !fs.existsSync(path.join(clone, word))) problems.push(`${where}: there is no ${word}`);
  const at = words.findIndex((word) => word === 'hop' || word === 'tools/hop');
  if (at < 0) return;
  const rest = words.slice(at + 1);
  const verb = verbWords(rest);
  if (verb.length === 0 && !rest[0]?.startsWith('--')) return problems.push(`${where}: unknown verb '${rest[0]}'`);
  for (const option of rest.filter((word) => word.startsWith('--')))
    if (!help(verb).stdout.includes(option.split('=')[0]))
      problems.push(`${where}: 'hop ${verb.join(' ')}' has no option ${option}`);
}

// Blocks marked as shell commands: line of the first command, and the lines.
function blocksOf(page) {
  const blocks = [];
  let block;
  fs.readFileSync(path.join(root, page), 'utf8').split('\n').forEach((text, index) => {
    if (!block && text === '```sh') block = { line: index + 2, lines: [] };
    else if (block && text.startsWith('```')) {
      blocks.push(block);
      block = undefined;
    } else block?.lines.push(text);
  });
  return blocks;
}

// Commands within a sentence are not run, but their options must exist.
function checkInline(page) {
  let inside = false;
  fs.readFileSync(path.join(root, page), 'utf8').split('\n').forEach((text, index) => {
    if (text.startsWith('```')) inside = !inside;
    if (inside) return;
    for (const [, command] of text.matchAll(/`((?:tools\/)?hop [a-z][^`]*)`/g)) checkCommand(`${page}:${index + 1}`, command);
  });
}

// Lines of a block that begin a command, without here-documents, continued lines, open quotes and loop
// bodies.
function commandsOf(block) {
  const commands = [];
  let end;
  block.lines.forEach((text, i) => {
    if (end) {
      if (text === end) end = undefined;
      return;
    }
    end = text.match(/<<'?(\w+)'?/)?.[1];
    const command = text.replace(/\s+# .*$/, '').trim();
    if (command && !command.startsWith('#')) commands.push({ where: block.line + i, command });
  });
  return commands;
}

function run(where, script, folder) {
  const result = spawnSync('bash', ['-e', '-o', 'pipefail', '-c', script], { cwd: folder, encoding: 'utf8', env: environment, timeout: 900_000 });
  if (result.status !== 0) problems.push(`${where}: ended with ${result.status ?? result.signal}\n${script}\n${result.stderr.slice(-800)}`);
}

fs.mkdirSync(path.join(work, 'made'));
execFileSync(hop, ['trial', '--no-report', '--output', path.join(work, 'made')],
  { env: { ...environment, SANDHOPPER_CONFIG: path.join(clone, 'config') }, stdio: 'ignore' });
const someLog = path.join(work, 'made', fs.readdirSync(path.join(work, 'made')).find((name) => name.endsWith('.mcap')));

let commands = 0;
const notRun = [];
for (const page of pages) {
  const folder = path.join(work, page.replaceAll('/', '_'));
  fs.mkdirSync(folder);
  for (const entry of fs.readdirSync(clone)) fs.symlinkSync(path.join(clone, entry), path.join(folder, entry));
  for (const name of ['LOG.mcap', 'my_trial.mcap']) fs.copyFileSync(someLog, path.join(folder, name));
  checkInline(page);
  for (const block of blocksOf(page)) {
    const list = commandsOf(block);
    commands += list.length;
    for (const { where, command } of list) checkCommand(`${page}:${where}`, command);
    const left = list.filter(({ command }) => reasonNotToRun(command));
    for (const { where, command } of left) notRun.push(`${page}:${where}: ${command}: ${reasonNotToRun(command)}`);
    if (left.length === 0) run(`${page}:${block.line}`, block.lines.join('\n'), folder);
    else for (const { where, command } of list) if (!reasonNotToRun(command)) run(`${page}:${where}`, command, folder);
  }
}
console.log(fs.readFileSync(ran, 'utf8'));
console.log(`not run:\n${notRun.join('\n')}`);
const runs = fs.readFileSync(ran, 'utf8').trim().split('\n').length;
console.log(`${commands} commands on ${pages.length} pages, ${notRun.length} not run, hop ran ${runs} times`);
if (process.argv.length <= 3 && runs < 20) problems.push(`hop ran only ${runs} times`);
fs.rmSync(work, { recursive: true });
for (const problem of problems) console.error(problem);
process.exit(problems.length ? 1 : 0);
