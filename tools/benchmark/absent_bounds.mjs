// Hides one effect at a time and compares its size with the upper bound that the answer prints in `absent`.
//   node tools/benchmark/absent_bounds.mjs HOP SEED COUNT [--keep FILE] [PLANT…]
// HOP is bin/hop. Effects of the plants take turns; size .3 to 3 times typical and 3 to 6 trials are drawn
// from SEED. Prints a line for each campaign and the counts. With --keep the lines are added to FILE, and a
// campaign that has its line there is not run again. Exit status 1 if a bound lies below the size.
import { execFileSync, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

// Uniform in 0 to 1 (mulberry32), so that the same seed draws the same sizes everywhere.
function uniform(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

// Effects on the list of `hop diagnose`, by plant.
function listed(hop) {
  const effects = {};
  let plant = '';
  for (const line of execFileSync(hop, ['conceal', '--list'], { encoding: 'utf8' }).split('\n')) {
    if (/^\w/.test(line)) effects[plant = line.trim()] = [];
    else if (/^ +\S+$/.test(line)) effects[plant].push(line.trim());
  }
  return effects;
}

function drawn(hop, plants, count, seed) {
  const effects = listed(hop), draw = uniform(seed);
  const pairs = plants.flatMap((plant) => effects[plant].map((effect) => ({ plant, effect })));
  for (let i = pairs.length - 1; i > 0; --i) {
    const j = Math.floor(draw() * (i + 1));
    [pairs[i], pairs[j]] = [pairs[j], pairs[i]];
  }
  return Array.from({ length: count }, (_, i) => ({ ...pairs[i % pairs.length], seed: seed + i,
    size: (0.3 * 10 ** draw()).toFixed(3), trials: 3 + Math.floor(draw() * 4) }));
}

const withoutChange = (name) => name.replace('_change', '');

// Number of a key in nominal.toml, which holds each key once; 0 if it does not.
function believed(folder, key) {
  const found = fs.readFileSync(path.join(folder, 'campaigns', '001', 'nominal.toml'), 'utf8')
    .match(new RegExp(`^${key} = (\\S+)$`, 'm'));
  return found ? Number(found[1]) : 0;
}

// Hidden size that a bound is about: of the same name, else the only number; NaN if there is none. An answer that
// gives the new number hides its difference from the belief.
function sizeOf({ parameter }, parameters, folder) {
  const numbers = Object.entries(parameters).filter(([, value]) => typeof value === 'number');
  const same = numbers.find(([name]) => withoutChange(name) === withoutChange(parameter));
  const [name, value] = same ?? (numbers.length === 1 ? numbers[0] : ['', NaN]);
  const isNew = same && parameter.includes('_change') && !name.includes('_change');
  return Math.abs(isNew ? value - believed(folder, name) : value);
}

// Bounds of the hidden effect in an answer, each with the hidden size.
function compared(truth, absent, folder) {
  return truth.effects.flatMap(({ id, parameters }) => absent
    .filter((bound) => bound.id === id || bound.id === `${id}[${parameters.channel}]`)
    .map((bound) => ({ bound, hidden: sizeOf(bound, parameters, folder) })));
}

// A stiffness or a limit is bounded from below: it falls as the effect grows.
const fails = ({ bound, hidden }) => hidden > bound.upper_bound || hidden < bound.lower_bound;

function run(hop, folder, { plant, effect, seed, size, trials }) {
  const made = spawnSync(hop, ['conceal', '--output', folder, '--campaigns', '1', '--seed', seed, '--plant', plant,
    '--kind', 'single', '--effect', effect, '--size', size, '--trials', trials].map(String), { encoding: 'utf8' });
  const file = path.join(folder, 'answers', '001.json');
  if (made.status !== 0 || !fs.existsSync(file)) return { problem: `not hidden: ${made.stderr.trim()}` };
  const told = spawnSync(hop, ['diagnose', path.join(folder, 'campaigns', '001'), '--output', path.join(folder, 'd'),
    '--json', '--no-report'], { encoding: 'utf8', maxBuffer: 1 << 28 });
  if (!told.stdout) return { problem: `no answer: ${told.stderr.trim().split('\n').pop()}` };
  const answer = JSON.parse(told.stdout);
  return { answer, cases: compared(JSON.parse(fs.readFileSync(file)), answer.absent ?? [], folder) };
}

// The result of one campaign in words.
function told({ problem, answer, cases }) {
  if (problem) return problem;
  const names = answer.effects.map(({ id, probability }) => `${id} ${probability.toFixed(2)}`).join(', ');
  const bounds = cases.map(({ bound, hidden }) => `${bound.id} ${bound.parameter}: hidden ` +
    `${hidden.toPrecision(4)}, bound ${(bound.upper_bound ?? bound.lower_bound).toPrecision(4)}`).join(', ');
  return `${answer.verdict} [${names}] ${answer.seconds.toFixed(1)} s; ${bounds || 'no bound'}` +
    (cases.some(fails) ? ' BELOW' : '');
}

const words = process.argv.slice(2), at = words.indexOf('--keep');
const keep = at >= 0 ? words.splice(at, 2)[1] : '';
const [hop, seed, count, ...named] = words;
const plants = named.length > 0 ? named : ['rotary_axis', 'intruder', 'falling_body'];
const kept = keep && fs.existsSync(keep) ? fs.readFileSync(keep, 'utf8').split('\n') : [];
const lines = [];
for (const wanted of drawn(hop, plants, Number(count), Number(seed))) {
  const head = `${wanted.plant} ${wanted.effect} size ${wanted.size} trials ${wanted.trials} seed ${wanted.seed}: `;
  let line = kept.find((one) => one.startsWith(head));
  if (!line) {
    const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'absent_bounds_'));
    line = head + told(run(hop, folder, wanted));
    fs.rmSync(folder, { recursive: true });
    if (keep) fs.appendFileSync(keep, `${line}\n`);
  }
  console.log(line);
  lines.push(line);
}
const answered = lines.filter((line) => / s; /.test(line));
const bounded = answered.filter((line) => !/no bound$/.test(line)), below = answered.filter((line) => / BELOW$/.test(line));
console.log(`${answered.length} hidden effects answered, ${bounded.length} of them bounded as absent, ` +
  `${below.length} bounds below the hidden size`);
process.exit(below.length > 0 || answered.length === 0 ? 1 : 0);
