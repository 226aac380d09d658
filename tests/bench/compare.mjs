// Compares the stiffnesses of two trials' JSON: compare.mjs A B relative LIMIT | interval
// interval: |k_a - k_b| within the root sum of squares of the half widths of both 95 % intervals.
import { readFileSync } from 'node:fs';

const [fileA, fileB, mode, limit] = process.argv.slice(2);
const [a, b] = [fileA, fileB].map((file) => JSON.parse(readFileSync(file, 'utf8')).strides);
let failed = a.length === 0 || a.length !== b.length;
if (failed) console.log(`FAILED: ${a.length} and ${b.length} strides`);
for (let i = 0; i < Math.min(a.length, b.length); ++i) {
  for (const [name, one] of Object.entries(a[i].stiffness_N_per_m)) {
    const other = b[i].stiffness_N_per_m[name];
    if (!one.valid && !other.valid) {
      console.log(`stride ${i + 1} ${name}: not valid on both, ${one.reason} / ${other.reason}`);
      continue;
    }
    const half = (k) => (k.ci95[1] - k.ci95[0]) / 2;
    const difference = Math.abs(one.value - other.value);
    const allowed = mode === 'relative' ? Number(limit) * other.value : Math.hypot(half(one), half(other));
    const good = one.valid === other.valid && difference <= allowed;
    failed ||= !good;
    console.log(`stride ${i + 1} ${name}: ${one.value.toFixed(1)} and ${other.value.toFixed(1)} N/m, ` +
      `${(100 * difference / other.value).toFixed(2)} % apart, allowed ${(100 * allowed / other.value).toFixed(2)} %` +
      `${good ? '' : '  FAILED'}`);
  }
}
process.exit(failed ? 1 : 0);
