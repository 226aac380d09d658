// Compares two answers of `hop diagnose`: words must be equal, numbers of diagnosis.json to a relative 1e-6,
// and rounded numbers to one unit of their last digit. Times of the run are left out.
export const tolerance = 1e-6;

// Paths in two JSON values that differ, as lines "path: one, other".
export function json_differences(one, other, path = '') {
  if (path === '/seconds') return [];
  if (typeof one === 'number' && typeof other === 'number') {
    const same = Math.abs(one - other) <= tolerance * Math.max(Math.abs(one), Math.abs(other));
    return same ? [] : [`${path}: ${one}, ${other}`];
  }
  if (one === null || other === null || typeof one !== 'object' || typeof other !== 'object') {
    return one === other ? [] : [`${path}: ${JSON.stringify(one)}, ${JSON.stringify(other)}`];
  }
  const found = [];
  const [keys, others] = [Object.keys(one), Object.keys(other)];
  if (keys.join('\n') !== others.join('\n')) found.push(`${path}: keys ${keys.join(' ')}, ${others.join(' ')}`);
  for (const key of keys) if (key in other) found.push(...json_differences(one[key], other[key], `${path}/${key}`));
  return found;
}

const run_facts = [
  /[\d.e+-]+ in [\d.e+-]+ s, [\d.e+-]+ a second/g,              // the page
  /^\d+ simulations in .*$/gm,                                   // the text
  /^(corrected model|answer|page|residuals): .*$/gm,  // text: paths that the caller chose
];
const number = /-?\d+(?:\.\d+)?(?:e[-+]?\d+)?/g;

function close(one, other) {
  if (one === other) return true;
  if (!/[.e]/.test(one) && !/[.e]/.test(other)) return false;  // counts
  const unit = text => {
    const [, decimals = '', exponent = '0'] = /^-?\d+(?:\.(\d+))?(?:e(.*))?$/.exec(text);
    return 10 ** (Number(exponent) - decimals.length);
  };
  const apart = Math.abs(Number(one) - Number(other));
  return apart <= 1.001 * Math.max(unit(one), unit(other)) || apart <= tolerance * Math.abs(Number(one));
}

// The first line that differs in two texts for readers, or null.
export function text_difference(one, other) {
  const plain = text => run_facts.reduce((left, fact) => left.replace(fact, ''), text).split('\n');
  const [lines, others] = [plain(one), plain(other)];
  if (lines.length !== others.length) return `${lines.length} lines, ${others.length}`;
  for (const [i, line] of lines.entries()) {
    const [a, b] = [line.match(number) ?? [], others[i].match(number) ?? []];
    if (line.replace(number, '#') !== others[i].replace(number, '#') || a.some((text, k) => !close(text, b[k]))) {
      const at = [...line].findIndex((letter, k) => letter !== others[i][k]);
      return `line ${i + 1}: …${line.slice(Math.max(0, at - 30), at + 50)}…, …${others[i].slice(Math.max(0, at - 30), at + 50)}…`;
    }
  }
  return null;
}
