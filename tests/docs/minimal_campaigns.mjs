// The minimal campaigns of the guide, and the example of the recording contract, as they stand there: each is written into a
// folder with a recording that has its columns, and `hop campaign check` takes it without a word about it.
//   node minimal_campaigns.mjs BUILD_FOLDER
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

const root = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), '../..');
const hop = path.join(path.resolve(process.argv[2]), 'bin/hop');
const work = fs.mkdtempSync(path.join(os.tmpdir(), 'hop-minimal-'));

function check(folder) {
  const { status, stdout } = spawnSync(hop, ['campaign', 'check', folder, '--json'], { encoding: 'utf8' });
  return { status, answer: JSON.parse(stdout) };
}

// Pairs of blocks after a mark: [plant, campaign.toml, nominal.toml].
function campaignsOf(page) {
  const text = fs.readFileSync(path.join(root, page), 'utf8');
  return [...text.matchAll(/<!-- campaign: (\w+) -->\n```toml\n([^]*?)```\n\n```toml\n([^]*?)```/g)].map((match) => match.slice(1));
}

// One second of motion with every channel and a little noise. A value that never changes would look like a
// dead sensor.
let state = 1;
const noise = () => ((state = (state * 48271) % 2147483647) / 2147483647 - 0.5);
const rows = Array.from({ length: 1000 }, (_, i) => 0.001 * i);
const recordings = {
  intruder: () => ['time,depth_mm,force',
    ...rows.map((t) => `${t.toFixed(3)},${(20 * t - 2 + 0.01 * noise()).toFixed(4)},${(Math.max(0, 30 * t - 3) + 0.1 * noise()).toFixed(4)}`)],
  falling_body: () => ['t,y_cm', ...rows.map((t) => `${t.toFixed(3)},${(350 - 490.5 * t * t + 0.5 * noise()).toFixed(4)}`)],
  rotary_axis: () => ['time,angle_deg,torque',
    ...rows.map((t) => `${t.toFixed(3)},${(30 * Math.sin(6 * t) + 0.02 * noise()).toFixed(4)},${(0.4 * Math.sin(6 * t) + 0.01 * noise()).toFixed(4)}`)],
  hopper: () => {
    const made = path.join(work, 'made');
    assert.equal(spawnSync(hop, ['campaign', 'make', '--trials', '1', '--output', made], {
      env: { ...process.env, SANDHOPPER_CONFIG: path.join(root, 'config') } }).status, 0);
    return fs.readFileSync(path.join(made, 'trials/0001.csv'), 'utf8').trim().split('\n');
  },
};

const campaigns = campaignsOf('tools/docs/guide/minimal_campaigns.md');
assert.deepEqual(campaigns.map(([plant]) => plant).sort(), ['falling_body', 'hopper', 'intruder', 'rotary_axis']);
for (const [plant, campaign, nominal] of campaigns) {
  const folder = path.join(work, plant);
  fs.mkdirSync(folder);
  fs.writeFileSync(path.join(folder, 'campaign.toml'), campaign);
  fs.writeFileSync(path.join(folder, 'nominal.toml'), nominal);
  fs.writeFileSync(path.join(folder, campaign.match(/^file += "(.*?)"/m)[1]), recordings[plant]().join('\n') + '\n');
  const { status, answer } = check(folder);
  assert.equal(answer.plant, plant);
  assert.equal(answer.usable, 1, JSON.stringify(answer.findings));
  assert.deepEqual(answer.findings, [], plant);
  assert.equal(status, 0);
}

// The example of the contract: its recordings are missing, and nothing else may be wrong.
const contract = fs.readFileSync(path.join(root, 'tools/docs/guide/recordings.md'), 'utf8');
const example = contract.match(/```toml\n(name  = [^]*?)```/)[1];
fs.mkdirSync(path.join(work, 'contract'));
fs.writeFileSync(path.join(work, 'contract/campaign.toml'), example);
fs.writeFileSync(path.join(work, 'contract/nominal.toml'), contract.match(/```toml\n(\[terrain\][^]*?)```/)[1]);
const { status, answer } = check(path.join(work, 'contract'));
assert.equal(status, 1);
assert.equal(answer.trials, 2);
for (const finding of answer.findings) assert.equal(finding.kind, 'missing_file', JSON.stringify(finding));

fs.rmSync(work, { recursive: true });
console.log(`ok ${campaigns.length} minimal campaigns and the contract's example`);
