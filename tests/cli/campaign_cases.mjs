// Defects of a campaign, the place where each must be reported (line:character), and the text of the message.
// `recording` changes the lines of trials/0003.csv (null: removed), `campaign` the text of campaign.toml.
// `usable`: the trial is still analysed; `keeps`: the part of it that must remain; `without`: the channel that the last line of
// `hop campaign check` names.

const kForce = 'load_cell_force_N';
const columns = rows => rows[0].split(',');
const cells = row => row.split(',');
// First character of a column's cell in a line of the file.
const character = (rows, line, name) => cells(rows[line - 1]).slice(0, columns(rows).indexOf(name)).join(',').length + 2;

// Changes the cells of one column from line `from` on.
function change(rows, name, from, change_cell) {
  const place = columns(rows).indexOf(name);
  return rows.map((row, i) => {
    if (i + 1 < from) return row;
    const all = cells(row);
    all[place] = change_cell(all[place], i + 1);
    return all.join(',');
  });
}
const in_line = (line, text) => (cell, at) => (at === line ? text : cell);
const with_observer = trial => trial.quantities.stiffness_observer_wls_A_N_per_m?.value > 500;
const without_cell = trial => with_observer(trial) && trial.ruled_out.some(reason => reason.includes(kForce));

export const breakages = [
  { name: 'non-numeric cell', kinds: ['non_numeric_cell'], usable: true, keeps: with_observer,
    recording: rows => change(rows, 't_s', 2, cell => cell).map((row, i) => (i === 499 ? row.replace(/^([^,]*),[^,]*/, '$1,fail') : row)),
    place: '500:7', says: ['motor_left_position_rad: "fail" is not a number', 'leave the cell empty'] },
  { name: 'infinity', kinds: ['nan_cell'], usable: true, keeps: with_observer,
    recording: rows => change(rows, 'motor_left_position_rad', 500, (cell, at) => (at < 503 ? 'inf' : cell)),
    place: '500:7', says: ['"inf" is not a finite number', 'leave the cell empty', 'and 2 more like it'] },
  { name: 'time going backwards', kinds: ['time_backwards'], usable: true, keeps: with_observer,
    recording: rows => change(rows, 't_s', 500, in_line(500, '0.2')),
    place: '500:1', says: ['time goes backwards', 'row left out', 'sort the rows'] },
  { name: 'clock set back for good', kinds: ['time_backwards'], usable: false,
    recording: rows => change(rows, 't_s', 300, (cell) => String(Number(cell) - 0.29)),
    place: '300:1', says: ['the time begins again in this line', 'the clock was set back'] },
  { name: 'duplicate column', kinds: ['duplicate_column'], usable: true, keeps: without_cell,
    recording: rows => [rows[0].replace('phase', kForce), ...rows.slice(1)],
    place: '1', says: [`${kForce}: a second column bears this name`, 'rename one of them'] },
  { name: 'unknown unit', kinds: ['unknown_unit'], usable: true, keeps: without_cell,
    recording: rows => [rows[0].replace(kForce, 'load_cell_force_kN'), ...rows.slice(1)],
    place: '1', says: ['looks like channel load_cell_force_N in the unit "kN"', 'load_cell_force_N = { column = "load_cell_force_kN", scale = 1000 }'] },
  { name: 'unit nobody knows', kinds: ['unknown_unit'], usable: true, keeps: without_cell,
    recording: rows => [rows[0].replace(kForce, 'load_cell_force_V'), ...rows.slice(1)],
    place: '1', says: ['in the unit "V"', 'say what it is in SI units'] },
  { name: 'gap', kinds: ['gap'], usable: true, keeps: with_observer,
    recording: rows => rows.filter((_, i) => i < 199 || i >= 230),
    place: '200:1', says: ['a gap of 0.032 s', 'used as they are'] },
  { name: 'saturated channel', kinds: ['saturated'], usable: true, keeps: with_observer,
    recording: rows => change(rows, kForce, 2, cell => (cell !== '' && Number(cell) > 25 ? '25.0' : cell)),
    place: '', says: [`${kForce}: is saturated`, '25', 'larger range'] },
  { name: 'stuck channel', kinds: ['stuck'], usable: true, without: kForce, keeps: without_cell,
    recording: rows => change(rows, kForce, 2, cell => (cell === '' ? '' : '3.25')),
    place: '11', says: [`${kForce}: is stuck`, 'check the sensor and its cable'] },
  { name: 'stuck from some line on', kinds: ['stuck'], usable: true,
    recording: rows => change(rows, 'motor_right_position_rad', 500, cell => (cell === '' ? '' : '1.1234')),
    place: '500', says: ['motor_right_position_rad: is stuck at 1.1234 from here', 'check the sensor'] },
  { name: 'missing file', kinds: ['missing_file'], usable: false, in_campaign: true,
    recording: () => null, place: '18:8', says: ['0003.csv does not exist', 'correct file ='] },
  { name: 'wrong plant', kinds: ['wrong_plant'], usable: false,
    recording: rows => ['t_s,foot_z_m,force_N', ...rows.slice(1, 100).map((row, i) => `${cells(row)[0]},${-0.001 * i},${i}`)],
    place: '1:5', says: ['foot_z_m, force_N are channels of plant "intruder"', 'correct plant in campaign.toml'] },
  { name: 'empty file', kinds: ['empty_file'], usable: false, recording: () => [],
    place: '1:1', says: ['the file is empty', 'record the trial again'] },
  { name: 'header alone', kinds: ['empty_file'], usable: false, recording: rows => rows.slice(0, 1),
    place: '1:1', says: ['no rows below the header', 'record the trial again'] },
  { name: 'no header', kinds: ['no_header'], usable: false, recording: rows => rows.slice(1).map(row => row.replace(/,,|,$/g, ',0')),
    place: '1:1', says: ['no header', 'names in the first line'] },
  { name: 'ragged row', kinds: ['ragged_row'], usable: true, keeps: with_observer,
    recording: rows => rows.map((row, i) => (i === 499 ? `${row},7` : row)),
    place: '500', says: ['cells where the header names', 'row left out', 'as many cells as the header'] },
  { name: 'time under another name', kinds: ['no_time'], usable: false, recording: rows => [rows[0].replace('t_s', 'time_ms'), ...rows.slice(1)],
    place: '1:1', says: ['no column is called "t_s"', 't_s = { column = "time_ms", scale = 0.001 }'] },
  { name: 'columns nobody knows', kinds: ['unknown_column'], usable: false,
    recording: rows => [columns(rows).map((name, i) => (i ? `ch${i}` : name)).join(','), ...rows.slice(1)],
    place: '1:1', says: ['no column is a channel of plant "hopper"', '[columns]'] },
  { name: 'unknown kind', kinds: ['set_up'], usable: false, in_campaign: true,
    campaign: text => text.replace(/("trials\/0003.csv"\nkind = )"hop"/, '$1"jump"'),
    place: '19:8', says: ['kind: is no kind of trial', '"intrusion"'] },
  { name: 'impossible set-up', kinds: ['set_up'], usable: false, in_campaign: true,
    campaign: text => text.replace(/("trials\/0003.csv"\n)/, '$1foot_mass_kg = -1.0\n'),
    place: '19:16', says: ["'foot_mass_kg' is out of range", 'expected a number from 0 to 20 kg'] },
];
