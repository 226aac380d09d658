#!/usr/bin/env node
// Tests the comparison of golden answers with equal, almost equal and different answers.
import assert from 'node:assert/strict';

import { json_differences, text_difference } from './differences.mjs';

const answer = {
  verdict: 'missing_physics', seconds: 3.25, trials: 12,
  effects: [{ id: 'axis.coulomb', probability: 0.97, parameters: { torque_Nm: { value: 0.12, ci95: [0.11, 0.13] } } }],
};
const changed = change => {
  const copy = structuredClone(answer);
  change(copy, copy.effects[0]);
  return json_differences(answer, copy);
};
assert.deepEqual(changed(() => {}), []);
assert.deepEqual(changed(all => (all.seconds = 9)), []);
assert.deepEqual(changed((_, effect) => (effect.parameters.torque_Nm.value *= 1 + 5e-7)), []);
assert.equal(changed((_, effect) => (effect.parameters.torque_Nm.value *= 1 + 2e-6)).length, 1);
assert.equal(changed((_, effect) => (effect.parameters.torque_Nm.value = null)).length, 1);
assert.equal(changed((_, effect) => (effect.probability = 0.969)).length, 1);
assert.equal(changed((_, effect) => (effect.id = 'axis.viscous')).length, 1);
assert.equal(changed(all => (all.verdict = 'consistent')).length, 1);
assert.equal(changed(all => (all.effects = [])).length, 1);
assert.equal(changed(all => (all.note = 'more')).length, 1);
assert.equal(changed(all => (all.trials = 13)).length, 1);

const text = 'verdict: missing_physics. torque_Nm = 0.120 after 12 trials\n19744 simulations in 114.0 s (173 a second)\n';
const same = (from, to) => text_difference(text, text.replace(from, to)) === null;
assert(same('', ''));
assert(same('114.0 s (173', '195.9 s (101'));
assert(same('0.120', '0.121'));
assert(!same('0.120', '0.122'));
assert(!same('12 trials', '13 trials'));
assert(!same('missing_physics', 'consistent'));
assert(!same('after', 'after all'));
console.log('all as it should be');
