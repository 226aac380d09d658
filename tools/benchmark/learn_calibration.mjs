// The largest probability of a name (tools/diagnose/evidence/calibration.hpp) and the map from the posterior mass of a
// claim to the probability that it is right, fitted to the claims of calibration_claims.csv, and how a map that was fitted on the other
// programs does on the program left out.
//   node tools/benchmark/learn_calibration.mjs              tables, and the maps
//   node tools/benchmark/learn_calibration.mjs --check      exit code 1 if the header holds another limit of names
//   node tools/benchmark/learn_calibration.mjs PROGRAM[:held_out]=ANSWERS=DIAGNOSES…
//                                                           first makes calibration_claims.csv anew
// ANSWERS is the folder `answers` of `hop conceal`, or a file {"cases": [{"name", "plant", "kind", "true_ids"}]} of
// another program; DIAGNOSES holds NAME/diagnosis.json. Claims that are held out are in no fit.
import fs from 'node:fs';
import path from 'node:path';

const file = new URL('calibration_claims.csv', import.meta.url);
const kFewest = 8;  // claims of one step of the map

const isUnknown = (id) => id.startsWith('unknown');

// The answers of both forms as [{ name, plant, kind, names }].
function answers(from) {
  if (!fs.statSync(from).isDirectory())
    return JSON.parse(fs.readFileSync(from, 'utf8')).cases
      .map(({ name, plant, kind, true_ids }) => ({ name, plant, kind, names: true_ids }));
  return fs.readdirSync(from).filter((entry) => entry.endsWith('.json')).sort().map((entry) => {
    const { plant, kind, effects } = JSON.parse(fs.readFileSync(path.join(from, entry), 'utf8'));
    return { name: entry.replace(/\.json$/, ''), plant, kind, names: effects.map(({ id }) => id) };
  });
}

function measure(sources) {
  const lines = ['program,held_out,campaign,plant,about,mass,right'];
  for (const source of sources) {
    const [program, from, diagnoses] = source.split('=');
    if (diagnoses === undefined) throw new Error(`"${source}": write PROGRAM=ANSWERS=DIAGNOSES`);
    const [name, held] = program.split(':');
    let campaign = 0;
    for (const truth of answers(from)) {
      const diagnosis = path.join(diagnoses, truth.name, 'diagnosis.json');
      if (!fs.existsSync(diagnosis)) continue;
      const { verdict, effects } = JSON.parse(fs.readFileSync(diagnosis, 'utf8'));
      ++campaign;
      if (verdict === 'consistent') continue;
      for (const claim of effects.filter(({ id }) => !id.startsWith('data.'))) {
        const names = [claim.id, ...claim.indistinguishable_from];
        const right = isUnknown(claim.id) ? truth.kind === 'unknown' : names.some((id) => truth.names.includes(id));
        lines.push([name, held === undefined ? 0 : 1, campaign, truth.plant, isUnknown(claim.id) ? 'unknown' : 'name',
          claim.posterior_mass.toFixed(4), right ? 1 : 0].join(','));
      }
    }
  }
  fs.writeFileSync(file, lines.join('\n') + '\n');
}

function read() {
  const [, ...lines] = fs.readFileSync(file, 'utf8').trim().split('\n').map((line) => line.split(','));
  return lines.map(([program, heldOut, , plant, about, mass, right]) =>
    ({ program, heldOut: heldOut === '1', plant, about, mass: Number(mass), right: Number(right) }));
}

// Isotonic regression by pooling adjacent violators, on steps of at least kFewest claims; equal masses are never
// parted. Knots { mass, probability }: the mean mass of a step and (right + 1/2) / (claims + 1).
function fitted(claims) {
  const steps = [];
  for (const { mass, right } of [...claims].sort((a, b) => a.mass - b.mass)) {
    const last = steps.at(-1);
    if (last && (mass === last.highest || last.count < kFewest))
      Object.assign(last, { count: last.count + 1, right: last.right + right, sum: last.sum + mass, highest: mass });
    else steps.push({ count: 1, right, sum: mass, highest: mass });
  }
  const joined = [];
  const share = ({ right, count }) => (right + 0.5) / (count + 1);
  const join = (a, b) => ({ count: a.count + b.count, right: a.right + b.right, sum: a.sum + b.sum, highest: b.highest });
  for (let step of steps) {
    while (joined.length > 0 && (share(joined.at(-1)) >= share(step) || step.count < kFewest))
      step = join(joined.pop(), step);
    joined.push(step);
  }
  return joined.map((step) => ({ mass: step.sum / step.count, probability: share(step) }));
}

// From (0, 0) through the knots, constant beyond the last one: as calibration.hpp.
function mapped(knots, mass) {
  let before = { mass: 0, probability: 0 };
  for (const knot of knots) {
    if (mass < knot.mass)
      return before.probability + (knot.probability - before.probability) * (mass - before.mass) / (knot.mass - before.mass);
    before = knot;
  }
  return before.probability;
}

const mean = (values) => values.reduce((sum, value) => sum + value, 0) / Math.max(1, values.length);

// Scores of stated probabilities: Brier's, the logarithmic one, and the calibration error over tenths.
function scores(claims, stated) {
  const rows = claims.map((claim) => ({ p: stated(claim.mass), right: claim.right }));
  const clipped = (p) => Math.min(0.99, Math.max(0.01, p));
  const tenths = Array.from({ length: 10 }, (_, i) => rows.filter(({ p }) => Math.min(9, Math.floor(10 * p)) === i));
  return {
    brier: mean(rows.map(({ p, right }) => (p - right) ** 2)),
    log: mean(rows.map(({ p, right }) => -Math.log(right ? clipped(p) : 1 - clipped(p)))),
    error: tenths.reduce((sum, tenth) =>
      sum + tenth.length * Math.abs(mean(tenth.map(({ p }) => p)) - mean(tenth.map(({ right }) => right))), 0) / Math.max(1, rows.length),
  };
}

const knotsText = (knots) =>
  knots.map(({ mass, probability }) => `{${mass.toFixed(3)}, ${probability.toFixed(3)}}`).join(', ');

const text = ({ brier, log, error }) => [brier, log, error].map((value) => value.toFixed(3)).join(' ');

function tables(all, about) {
  const claims = all.filter((claim) => claim.about === about);
  const learnt = claims.filter(({ heldOut }) => !heldOut);
  console.log(`claims of a ${about}: right / claims with a mass below 0.5, to 0.9, to 0.99, above`);
  for (const key of ['program', 'plant'])
    for (const value of [...new Set(claims.map((claim) => claim[key]))]) {
      const own = claims.filter((claim) => claim[key] === value);
      const of = (low, high) => own.filter(({ mass }) => mass >= low && mass < high);
      const cell = (part) => `${part.filter(({ right }) => right).length}/${part.length}`;
      console.log(`  ${value} ${[of(0, 0.5), of(0.5, 0.9), of(0.9, 0.99), of(0.99, 2)].map(cell).join(' ')}`);
    }
  console.log('left out, claims: Brier, logarithmic score, calibration error with the mass | with the map of the others | with their limit');
  const row = (name, own, knots) =>
    console.log(`  ${name} ${own.length}: ${text(scores(own, (mass) => mass))} | ${text(scores(own, (mass) => mapped(knots, mass)))} | ${text(scores(own, (mass) => Math.min(mass, knots.at(-1).probability)))}`);
  for (const program of new Set(learnt.map((claim) => claim.program)))
    row(program, learnt.filter((claim) => claim.program === program),
      fitted(learnt.filter((claim) => claim.program !== program)));
  const knots = fitted(learnt);
  const heldOut = claims.filter((claim) => claim.heldOut);
  if (heldOut.length > 0) row('held out', heldOut, knots);
  console.log(`map: {${knotsText(knots)}}\n`);
}

// Exits with 1 if calibration.hpp holds another limit than the last step of the fit.
function check(claims) {
  const fit = fitted(claims.filter(({ about, heldOut }) => about === 'name' && !heldOut)).at(-1).probability.toFixed(3);
  const header = fs.readFileSync(new URL('../diagnose/evidence/calibration.hpp', import.meta.url), 'utf8');
  if (header.includes(`kMostOfAName = ${fit};`)) return;
  console.error(`calibration.hpp does not hold the limit of these claims: write kMostOfAName = ${fit}`);
  process.exit(1);
}

const sources = process.argv.slice(2);
if (sources[0] === '--check') {
  check(read());
  process.exit(0);
}
if (sources.length > 0) measure(sources);
const claims = read();
tables(claims, 'name');
tables(claims, 'unknown');
