// How far the laws of other programs differ from the listed ones, learnt from how far fitted sizes lie from the
// true ones: per plant the share phi of a size by which another form of the law moves its fit,
//   size - truth ~ N(0, sd^2 + (phi size)^2),   sd: what noise and scatter between trials leave
// Its prior is half-normal with scale 0.1. phi is the median of its posterior.
//   node tools/benchmark/learn_form.mjs              the learnt shares, and how they do on a program left out
//   node tools/benchmark/learn_form.mjs --json       the shares alone
// The claims are in form_claims.csv: campaigns with one hidden effect that was named.
import fs from 'node:fs';

const kQuantile = 2.13;  // Student's t, 95 %, 15 degrees of freedom, as the diagnosis takes for twelve trials
const kPriorScale = 0.1;
const kLargest = 0.5, kSteps = 2000;

const [head, ...lines] = fs.readFileSync(new URL('form_claims.csv', import.meta.url), 'utf8').trim().split('\n');
const columns = head.split(',');
const claims = lines.map((line) => Object.fromEntries(line.split(',').map((cell, i) =>
  [columns[i], ['size', 'sd', 'truth'].includes(columns[i]) ? Number(cell) : cell])));

function logPosterior(phi, of) {
  let sum = -0.5 * (phi / kPriorScale) ** 2;
  for (const { size, sd, truth } of of) {
    const variance = sd ** 2 + (phi * size) ** 2;
    sum -= 0.5 * Math.log(variance) + 0.5 * (size - truth) ** 2 / variance;
  }
  return sum;
}

function learnt(of) {
  const phi = Array.from({ length: kSteps }, (_, i) => kLargest * (i + 0.5) / kSteps);
  const logs = phi.map((one) => logPosterior(one, of));
  const most = Math.max(...logs), weights = logs.map((one) => Math.exp(one - most));
  const half = 0.5 * weights.reduce((a, b) => a + b, 0);
  let sum = 0;
  return phi.find((_, i) => (sum += weights[i]) >= half);
}

const holds = (phi, { size, sd, truth }) =>
  Math.abs(size - truth) <= kQuantile * Math.sqrt(sd ** 2 + (phi * size) ** 2);
const names = (key, of = claims) => [...new Set(of.map((claim) => claim[key]))].sort();

const shares = Object.fromEntries(names('plant').map((plant) =>
  [plant, learnt(claims.filter((claim) => claim.plant === plant))]));
if (process.argv.includes('--json')) {
  console.log(JSON.stringify(shares));
  process.exit(0);
}
for (const plant of names('plant')) {
  const own = claims.filter((claim) => claim.plant === plant);
  console.log(`${plant}: phi ${shares[plant].toFixed(3)} from ${own.length} sizes`);
  for (const program of names('program', own)) {
    const out = own.filter((claim) => claim.program === program);
    const phi = learnt(own.filter((claim) => claim.program !== program));
    const count = (share) => out.filter((claim) => holds(share, claim)).length;
    console.log(`  program ${program} left out: phi ${phi.toFixed(3)}; 95 % intervals hold ${count(phi)} of ` +
                `${out.length} (without phi ${count(0)})`);
  }
}
