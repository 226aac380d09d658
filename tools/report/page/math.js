// Sets an equation in plain text, such as "F += -1/2 rho A C_d |v| v", with Greek letters, indices, powers,
// and variables in italics.
const GREEK = { alpha: 'α', beta: 'β', gamma: 'γ', delta: 'δ', theta: 'θ', mu: 'μ', rho: 'ρ', tau: 'τ', tau1: 'τ₁', tau2: 'τ₂', phi: 'φ', xi: 'ξ', w: 'ω' };

function mathOf(text) {
  const parts = [];
  const pattern = /(->)|(\+=)|([A-Za-z][A-Za-z0-9]*)((?:_[A-Za-z0-9]+)?)|\^(\([^()]*\)|[A-Za-z0-9]+)|('+)|(-)|(\d[\d.]*)|(\s+)|([^])/g;
  for (const [all, arrow, gains, name, index, power, primes, minus] of text.matchAll(pattern)) {
    if (arrow) parts.push(' → ');
    else if (gains) parts.push(' += ');
    else if (name) parts.push(...nameOf(name, index));
    else if (power) parts.push(element('sup', {}, ...mathOf(power.replace(/^\(|\)$/g, ''))));
    else if (primes) parts.push(primes.length > 1 ? '″' : '′');
    else if (minus) parts.push('−');
    else parts.push(all);
  }
  return parts;
}

function nameOf(name, index) {
  const changed = /^d[A-Zlm]$/.test(name);  // dG: a change of G
  const bare = changed ? name.slice(1) : name;
  const letter = GREEK[bare] ?? bare;
  const variable = letter.length === 1 || /^[α-ω][₁₂]$/.test(letter) || (bare.length === 2 && /[0-9]$/.test(bare));
  const made = [...(changed ? ['Δ'] : []), variable ? element('i', {}, letter) : letter];
  if (index) made.push(element('sub', {}, GREEK[index.slice(1)] ?? index.slice(1)));
  return made;
}

// Text as a physicist writes it: a number stays on the line of its unit, "+-" becomes ±, and 1.2e-05 becomes
// 1.2×10⁻⁵. A text with "=" may be a line to copy into a file and keeps its characters.
function setText(text) {
  const kept = String(text).replace(/(\d) (?=(?:%|mm|m|cm|s|ms|N|kg|Hz|rad|N\/m|m\/s|m\/s²|°)(?![\w/²³]))/g, '$1\u00a0');
  if (kept.includes('=')) return kept;
  return kept.replace(/\+- /g, '±\u00a0').replace(/(\d)e([+-])0*(\d+)\b/g, (_, digit, sign, power) =>
    `${digit}×10${sign === '-' ? '⁻' : ''}${[...power].map(one => '⁰¹²³⁴⁵⁶⁷⁸⁹'[one]).join('')}`);
}
