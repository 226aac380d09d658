// Sets the plain equations of the text: C_d, v^2, z^(n - 1), sqrt(…), +-. Code stays as it is written.
'use strict';
const kGreek = { lambda: 'λ', theta: 'θ', rho: 'ρ', pi: 'π' };
const kPlainMaths = new RegExp([
  '\\b(d?[A-Za-z])_([A-Za-z0-9]{1,3})(?!\\w|\\.\\w)',  // an index
  '\\^(-?\\d+(?:\\.\\d+)?|[a-z]\\b|\\([^()]*\\))',  // a power
  '\\b(sqrt)(?=\\()', '(\\+-)', '(<=|>=)',
  '\\b(lambda|theta|rho|pi(?= [A-Z]\\b))\\b',
].join('|'), 'g');

function setMaths(text) {
  const parts = [];
  let done = 0;
  const made = (tag, content) => Object.assign(document.createElement(tag), { textContent: content });
  for (const match of text.matchAll(kPlainMaths)) {
    const [all, name, index, power, root, both, bound, greek] = match;
    parts.push(text.slice(done, match.index));
    done = match.index + all.length;
    if (name) parts.push(made('i', name), made('sub', index));
    else if (power) parts.push(made('sup', power.replace(/^\(|\)$/g, '').replace('-', '−')));
    else if (root) parts.push('√');
    else if (both) parts.push('±');
    else if (bound) parts.push(bound === '<=' ? '≤' : '≥');
    else parts.push(made('i', kGreek[greek]));
  }
  return done ? [...parts, text.slice(done)] : null;
}

const texts = document.createTreeWalker(document.querySelector('main'), NodeFilter.SHOW_TEXT);
const found = [];
for (let node = texts.nextNode(); node; node = texts.nextNode()) {
  if (node.parentElement.closest('pre, code, script, style')) continue;
  const parts = setMaths(node.data);
  if (parts) found.push([node, parts]);
}
for (const [node, parts] of found) node.replaceWith(...parts);
