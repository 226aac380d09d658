// Letters of an equation that fits a column; it is not broken.
const kShortEquation = 24;

// Sets an equation in plain text, such as "F += -1/2 rho A C_d |v| v", with Greek letters, indices, powers,
// and variables in italics.
const GREEK = { alpha: 'α', beta: 'β', gamma: 'γ', delta: 'δ', theta: 'θ', mu: 'μ', rho: 'ρ', tau: 'τ', tau1: 'τ₁', tau2: 'τ₂', phi: 'φ', psi: 'ψ', sigma: 'σ',
  lambda: 'λ', pi: 'π', xi: 'ξ', w: 'ω', sqrt: '√', integral: '∫' };

function mathOf(text) {
  const parts = [];
  const pattern = /(->)|(\+=)|(<=|>=)|([A-Za-z][A-Za-z0-9]*)((?:_[A-Za-z0-9]+)?)|\^(\([^()]*\)|-?[A-Za-z0-9]+)|('+)|(-)|(\d[\d.]*)|(\s+)|([^])/g;
  for (const match of text.matchAll(pattern)) {
    const [all, arrow, gains, bound, name, index, power, primes, minus] = match;
    if (arrow) parts.push(' → ');
    else if (gains) parts.push(' += ');
    else if (bound) parts.push(bound === '<=' ? '≤' : '≥');
    else if (name === 'a' && isArticle(text, match.index)) parts.push(name);
    else if (name) parts.push(...nameOf(name, index));
    else if (power) parts.push(element('sup', {}, ...mathOf(power.replace(/^\(|\)$/g, ''))));
    else if (primes) parts.push(primes.length > 1 ? '″' : '′');
    else if (minus) parts.push('−');
    else parts.push(all);
  }
  return parts;
}

// True for the "a" of "into a liquid" in an equation with words.
function isArticle(text, at) {
  return /[A-Za-z]{2,} $/.test(text.slice(0, at)) && /^ [A-Za-z]{2,}/.test(text.slice(at + 1));
}

function nameOf(name, index) {
  const changed = /^d[A-Zlm]$/.test(name);  // dG: a change of G
  const bare = changed ? name.slice(1) : name;
  const letter = GREEK[bare] ?? bare;
  const variable = (letter.length === 1 && !/[√∫]/.test(letter)) || /^[α-ω][₁₂]$/.test(letter) || (bare.length === 2 && /[0-9]$/.test(bare));
  const made = [...(changed ? ['Δ'] : []), variable ? element('i', {}, letter) : letter];
  if (index) made.push(element('sub', {}, GREEK[index.slice(1)] ?? index.slice(1)));
  return made;
}

// Text as a physicist writes it: a number stays on the line of its unit, "+-" becomes ±, and 1.2e-05 becomes
// 1.2×10⁻⁵. A text with "=" may be a line to copy into a file and keeps its characters.
function setText(text) {
  const kept = String(text).replace(/(\d) (?=(?:%|mm|m|cm|cm²|s|ms|µs|N|kg|Hz|kHz|rad|N\/m|m\/s|m\/s²|rad\/s|°)(?![\w/²³]))/g, '$1\u00a0');
  if (kept.includes('=')) return kept;
  return kept.replace(/\+- /g, '±\u00a0').replace(/(\d)e([+-])0*(\d+)\b/g, (_, digit, sign, power) =>
    `${digit}×10${sign === '-' ? '⁻' : ''}${[...power].map(one => '⁰¹²³⁴⁵⁶⁷⁸⁹'[one]).join('')}`);
}

// A text for readers: setText(), with the equations between ⟦ and ⟧ set by mathOf().
function withMath(text) {
  return String(text).split(/⟦([^⟧]*)⟧/).map((part, i) => (i % 2 ? element('span', { className: part.length <= kShortEquation ? 'math short' : 'math' }, ...mathOf(part)) : setText(part)));
}

function withoutMath(text) {
  return String(text).replace(/[⟦⟧]/g, '');
}

// A long name may be broken after a dot, an underscore or a bracket, where a hyphen would be wrong.
function breakable(parts) {
  const places = word => word.split(/(?<=[._\]/])/).flatMap((piece, i) => (i ? [element('wbr'), piece] : [piece]));
  return parts.flatMap(part => (typeof part !== 'string' ? [part]
    : part.split(/(\S{15,})/).flatMap((piece, i) => (i % 2 ? places(piece) : [piece]))));
}
