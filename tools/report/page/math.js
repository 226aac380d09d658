// Sets an equation in plain text, such as "F += -1/2 rho A C_d |v| v", with Greek letters, indices, powers,
// and variables in italics.
const GREEK = { alpha: 'α', beta: 'β', gamma: 'γ', delta: 'δ', theta: 'θ', mu: 'μ', rho: 'ρ', tau: 'τ', phi: 'φ', xi: 'ξ', w: 'ω' };

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
  const variable = letter.length === 1 || (bare.length === 2 && /[0-9]$/.test(bare));
  const made = [...(changed ? ['Δ'] : []), variable ? element('i', {}, letter) : letter];
  if (index) made.push(element('sub', {}, GREEK[index.slice(1)] ?? index.slice(1)));
  return made;
}
