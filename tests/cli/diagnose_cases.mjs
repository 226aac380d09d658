// Other ways to write the same campaign. The answer of `hop diagnose` must not depend on them. A table is {
// header, rows } with text cells; an empty cell has no sample.

export function parse(text) {
  const [header, ...rows] = text.trimEnd().split('\n').map(line => line.split(','));
  return { header, rows };
}
export const print = table => `${[table.header, ...table.rows].map(row => row.join(',')).join('\n')}\n`;

export function shifted(table, by_s) {
  return { header: table.header, rows: table.rows.map(row => [String(Number(row[0]) + by_s), ...row.slice(1)]) };
}

// Rows at 500 Hz at most: rows in between are dropped, and a slow sensor's sample moves to the next row that
// is kept.
export function thinned(table, step_s = 0.002) {
  const carried = table.header.map(() => '');
  let next = -Infinity;
  const rows = [];
  for (const row of table.rows) {
    row.forEach((cell, c) => { if (cell !== '') carried[c] = cell; });
    const t = Number(row[0]);
    if (t < next) continue;
    rows.push(carried.map((cell, c) => (c === 0 ? row[0] : cell)));
    carried.fill('');
    next = t + step_s - 1e-4;
  }
  return { header: table.header, rows };
}

// The [[trial]] tables of campaign.toml, each with its text.
export function split_trials(toml) {
  const parts = toml.split(/^\[\[trial\]\]$/m);
  return { head: parts[0], trials: parts.slice(1) };
}
export const join_trials = ({ head, trials }) => head + trials.map(text => `[[trial]]${text}`).join('');
export const file_of = trial => trial.match(/file\s*=\s*"([^"]*)"/)[1];

export const rewritings = [
  { name: 'renamed, shuffled, from another zero of time', table: table => shifted(table, 137.25), trials: trials => [...trials].reverse(),
    rename: (_, i) => `recordings/${'qzkwvxj'[i % 7]}${(i * 37) % 101}.csv` },
  { name: 'at 500 Hz', table: thinned },
];
