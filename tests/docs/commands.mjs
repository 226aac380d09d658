// The commands that README and guide tell people to type: every script exists, every option is one the program knows, and
// what needs no robot is run, in the order in which it is read, in an empty folder a page (with a trial's log in it).
//   node commands.mjs BUILD_FOLDER
import { execFileSync, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

const root = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), '../..');
const hop = path.join(path.resolve(process.argv[2]), 'bin/hop');
const guide = path.join(root, 'tools/docs/guide');
const pages = [path.join(root, 'README.md'),
  ...['index', 'wiring', 'computer', 'motors', 'safety', 'calibration', 'first_hops', 'tuning', 'results', 'foreign_recordings', 'benchmark', 'versions',
    'extending']
    .map((name) => path.join(guide, `${name}.md`))];

const needsTheRobot = /--board linux|hop doctor|hop calibrate (?!.*--board sim)/;
const takesHours = /hop conceal benchmark/;
const environment = { ...process.env, SANDHOPPER_CONFIG: path.join(root, 'config'), SANDHOPPER_NO_BUILD: '1' };

const problems = [];
let folder = '';
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

function checkOptions(where, words) {
  const verb = verbWords(words);
  if (verb.length === 0 && !words[0]?.startsWith('--')) return problems.push(`${where}: unknown verb '${words[0]}'`);
  for (const option of words.filter((word) => word.startsWith('--')))
    if (!help(verb).stdout.includes(option.split('=')[0]))
      problems.push(`${where}: 'hop ${verb.join(' ')}' has no option ${option}`);
}

function emptyFolder() {
  folder = fs.mkdtempSync(path.join(os.tmpdir(), 'hop-docs-'));
  fs.symlinkSync(path.join(root, 'config'), path.join(folder, 'config'));
  for (const name of ['LOG.mcap', 'my_trial.mcap']) fs.copyFileSync(someLog, path.join(folder, name));
}

const made = fs.mkdtempSync(path.join(os.tmpdir(), 'hop-docs-'));
execFileSync(hop, ['trial', '--no-report', '--output', made], { env: environment, stdio: 'ignore' });
const someLog = path.join(made, fs.readdirSync(made).find((name) => name.endsWith('.mcap')));

function run(where, words) {
  const result = spawnSync(hop, words, { cwd: folder, encoding: 'utf8', env: environment, timeout: 1_500_000 });
  // 1: ran, and the answer is no; a diagnosis may say so.
  if (result.status !== 0 && !(result.status === 1 && words[0] !== 'replay'))
    problems.push(`${where}: 'hop ${words.join(' ')}' ended with ${result.status}\n${result.stderr.slice(-600)}`);
  console.log(`ran: hop ${words.join(' ')} (${result.status})`);
}

let lines = 0, ran = 0;
for (const page of pages) {
  let inside = false;
  emptyFolder();
  fs.readFileSync(page, 'utf8').split('\n').forEach((text, index) => {
    if (text.startsWith('```')) inside = !inside && text === '```sh';
    if (!inside || text.startsWith('```')) return;
    const where = `${path.relative(root, page)}:${index + 1}`;
    const command = text.replace(/\s+# .*$/, '').trim();
    if (command === '' || command.startsWith('#')) return;
    ++lines;
    const words = command.match(/"[^"]*"|\S+/g).map((word) => word.replaceAll('"', '')).filter((word) => word !== 'sudo');
    if (words[0].startsWith('tools/') || words[0].startsWith('tests/'))
      if (!fs.existsSync(path.join(root, words[0]))) problems.push(`${where}: there is no ${words[0]}`);
    const at = words.findIndex((word) => word === 'hop' || word === 'tools/hop');
    if (at < 0) return;
    const rest = words.slice(at + 1);
    checkOptions(where, rest);
    if (at > 0 || needsTheRobot.test(command) || takesHours.test(command)) return;
    if (rest.some((word) => /^[A-Z]+$/.test(word))) return;
    ++ran;
    run(where, rest);
  });
  fs.rmSync(folder, { recursive: true });
}
fs.rmSync(made, { recursive: true });
console.log(`${lines} lines, ${ran} run`);
if (ran < 10) problems.push(`only ${ran} commands were run`);
for (const problem of problems) console.error(problem);
process.exit(problems.length ? 1 : 0);
