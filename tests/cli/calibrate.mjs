#!/usr/bin/env node
// `hop calibrate` from the command line, every calibration once. The simulated devices differ from the configuration. The
// difference must be found within its interval, only the calibrated keys may change, and a refusal must change nothing.
//   tests/cli/calibrate.mjs [BUILD-DIRECTORY]
import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = resolve(dirname(fileURLToPath(import.meta.url)), '../..');
const hop = join(resolve(process.argv[2] ?? join(root, 'build')), 'bin/hop');
const folder = mkdtempSync(join(tmpdir(), 'hop-calibrate-'));
const [believed, real] = ['believed', 'real'].map((name) => join(folder, name));
for (const directory of [believed, real]) cpSync(join(root, 'config'), directory, { recursive: true });

let failed = 0;
function expect(right, text) {
  if (right) return;
  failed += 1;
  console.log(`WRONG: ${text}`);
}

function change(file, ...changes) {
  let text = readFileSync(file, 'utf8');
  for (const [from, to] of changes) {
    expect(typeof from === 'string' ? text.includes(from) : from.test(text), `${file} holds ${from}`);
    text = text.replace(from, to);
  }
  writeFileSync(file, text);
}

// True properties of the devices. The sensors' spread between trials is switched off, because it would add to
// them.
change(join(real, 'linux.toml'), ['scale_N_per_V = 100.0', 'scale_N_per_V = 92.5'], ['zero_V = 0.0', 'zero_V = 0.031'],
  ['mount_offset_m = 0.0 ', 'mount_offset_m = 0.0374'], ['accel_bias_mps2 = [0.0, 0.0, 0.0]', 'accel_bias_mps2 = [0.21, -0.34, 0.12]'],
  ['accel_scale = [1.0, 1.0, 1.0]', 'accel_scale = [1.013, 0.992, 1.006]'], ['latency_s = 0.00058', 'latency_s = 0.00158']);
change(join(real, 'robot.toml'), ['sign = 1 ', 'sign = -1 '], ['zero_offset_rad = 0.0 ', 'zero_offset_rad = 0.352 '],
  [/(name = "right"[^]*?)zero_offset_rad = 0.0/, '$1zero_offset_rad = -1.207'],
  ['torque_constant_Nm_per_A = 0.0868', 'torque_constant_Nm_per_A = 0.0741'],
  [/(name = "right"[^]*?)\ntorque_constant_Nm_per_A = 0.0868/, '$1\ntorque_constant_Nm_per_A = 0.0812']);
change(join(real, 'world.toml'), ['imu_raw_offset_mps2 = 0.2', 'imu_raw_offset_mps2 = 0.0'],
  ['imu_scale_relative = 0.005', 'imu_scale_relative = 0.0'], ['imu_gyro_bias_radps = 0.01', 'imu_gyro_bias_radps = 0.0'],
  ['tof_bias_m = 0.003', 'tof_bias_m = 0.0'], ['torque_constant_relative = 0.02', 'torque_constant_relative = 0.0'],
  ['load_cell_bandwidth_Hz = 300.0', 'load_cell_bandwidth_Hz = 400.0']);

let runs = 0;
function calibrate(what, ...options) {
  runs += 1;
  const output = join(folder, `out${runs}`);
  const run = spawnSync(hop, ['calibrate', what, '--board', 'sim', '--sim-devices', real, '--config', believed, '--output', output,
    '--json', ...options], { encoding: 'utf8', timeout: 60000 });
  let result = {};
  try {
    result = JSON.parse(run.stdout);
  } catch {
    expect(false, `${what}: one JSON object on standard output, got ${run.stdout}${run.stderr}`);
  }
  return { status: run.status, result, output, text: run.stderr };
}

const text_of = (file) => readFileSync(join(believed, file), 'utf8');

// Checks that each planted value is found within `times` intervals: 1 fails in one of twenty cases, 3 almost
// never.
function finds(what, file, truths, ...options) {
  const before = text_of(file);
  const dry = calibrate(what, '--dry-run', ...options);
  expect(dry.status === 0 && text_of(file) === before, `${what} --dry-run writes nothing: ${dry.text}`);
  const { status, result, output, text } = calibrate(what, ...options);
  expect(status === 0 && result.ok, `${what} ends with 0: ${text}`);
  for (const [key, truth] of Object.entries(truths)) {
    const found = (result.values ?? []).find((value) => value.key === key) ?? {};
    expect(Math.abs(found.after - truth) <= 3 * found.ci95_half_width, `${what}: ${key} ${found.after} +- ${found.ci95_half_width}, planted ${truth}`);
    console.log(`hop calibrate ${what}: ${key} ${found.before} -> ${found.after} +- ${found.ci95_half_width?.toPrecision(2)}, planted ${truth}`);
  }
  expect(existsSync(join(output, `${what}.html`)), `${what} leaves a page`);
  const after = text_of(file).split('\n');
  const changed = before.split('\n').filter((line, i) => line !== after[i]).length;
  expect(changed > 0 && changed <= result.values?.length + 1, `${what} changes only its own lines of ${file}, ${changed} did`);
  const check = spawnSync(hop, ['config', 'check', '--config', believed, '--json'], { encoding: 'utf8' });
  expect(check.status === 0, `what ${what} wrote is a right configuration: ${check.stderr}`);
  return { output, result };
}

const first = finds('load-cell', 'linux.toml', { 'load_cell.scale_N_per_V': 92.5, 'load_cell.zero_V': 0.031 });
finds('encoders', 'robot.toml', { 'motor[0].zero_offset_rad': 0.352, 'motor[1].zero_offset_rad': -1.207 });
expect(/name = "left"[^]*?sign = -1 [^]*?name = "right"[^]*?sign = 1/.test(text_of('robot.toml')), 'both signs');
finds('imu', 'linux.toml', { 'imu_body.accel_bias_mps2[1]': -0.34, 'imu_body.accel_scale[0]': 1.013 });
finds('tof', 'linux.toml', { 'tof.mount_offset_m': 0.0374 });
finds('torque-constant', 'robot.toml', { 'motor[0].torque_constant_Nm_per_A': 0.0741, 'motor[1].torque_constant_Nm_per_A': 0.0812 });
finds('timing', 'linux.toml', { 'load_cell.latency_s': 0.00158 });

// Recordings made with the old configuration must give the same values with the new one.
const logs = [1, 2, 3, 4, 5, 6, 7].map((n) => join(first.output, `recording_0${n}.mcap`));
const again = calibrate('load-cell', '--dry-run', '--from', ...logs);
for (const value of again.result.values ?? []) {
  const then = first.result.values.find((one) => one.key === value.key);
  expect(Math.abs(value.after - then.after) < 0.2 * value.ci95_half_width + 1e-12, `--from: ${value.key} ${value.after}, then ${then.after}`);
}

// A table written by hand: time and force, three weights, the last one with a wrong label.
const tables = [0, 1, 2, 3, 3, 0].map((mass_kg, n) => {
  const file = join(folder, `weight_${n}.csv`);
  const rows = Array.from({ length: 900 }, (_, i) => `${(i * 0.001).toFixed(3)},${9.81 * mass_kg + 0.1 * Math.sin(i * i)}`);
  writeFileSync(file, `t_s,load_cell_force_N\n${rows.join('\n')}\n`);
  return file;
});
const right = calibrate('load-cell', '--dry-run', '--weights-kg', '0,1,2,3,3,0', '--from', ...tables);
expect(right.status === 0, `tables by hand: ${right.text}`);
const files = text_of('linux.toml');
const wrong = calibrate('load-cell', '--weights-kg', '0,1,2.2,3,3,0', '--from', ...tables);
expect(wrong.status === 1 && wrong.result.refusals?.[0].reason === 'outlier' && wrong.result.refusals[0].cure, `a wrong label: ${wrong.text}`);
expect(text_of('linux.toml') === files, 'a refused calibration leaves the file alone');
const few = calibrate('load-cell', '--weights-kg', '0,1,2,3', '--from', ...tables);
expect(few.status === 2 && few.text.includes('6 recordings, 4 are needed'), `recordings are counted: ${few.text}`);
const twice = calibrate('load-cell', '--weights-kg', '0,1,2,0', '--from', ...tables.slice(0, 3), tables[0]);
expect(twice.status === 2 && twice.text.includes('is named twice'), `one recording is no repeat: ${twice.text}`);
const blind = spawnSync(hop, ['calibrate', 'tof', '--config', believed, '--output', join(folder, 'blind')], { encoding: 'utf8', input: '' });
expect(blind.status === 2 && blind.stderr.includes('--from'), `without a terminal: ${blind.stderr}`);

// A drive whose velocity field has half of the configured range.
change(join(real, 'robot.toml'), ['velocity_range_radps = 50.0', 'velocity_range_radps = 25.0'],
  ['motor_speed_radps = 40.0', 'motor_speed_radps = 20.0']);
const robot = text_of('robot.toml');
const ranged = calibrate('encoders');
const refused = ranged.result.refusals?.[0] ?? {};
expect(ranged.status === 1 && refused.reason === 'velocity_range_wrong' && refused.cure.includes('likely 25'), `half the velocity range: ${ranged.text}`);
expect(text_of('robot.toml') === robot, 'a velocity range that is wrong leaves the zeros alone');
console.log(`hop calibrate encoders: ${refused.found}: ${refused.cure}`);

rmSync(folder, { recursive: true });
console.log(`${failed} wrong`);
process.exit(failed ? 1 : 0);
