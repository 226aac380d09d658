// Creates SVG elements; their colours are variables of the style sheet.
function svgElement(tag, attributes = {}) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}

function svgText(text, attributes) {
  const made = svgElement('text', { fill: 'var(--quiet)', 'font-size': 11, ...attributes });
  made.textContent = text;
  return made;
}

// Text with equations between ⟦ and ⟧: indices and powers in smaller letters, variables in italics.
function svgEquation(text, attributes) {
  const made = svgText('', attributes);
  let line = 0;  // pixels by which the pen stands below the line
  const write = (content, level, look) => {
    made.append(Object.assign(svgElement('tspan', { ...look, dy: level - line }), { textContent: content }));
    line = level;
  };
  const walk = (parts, level, look) => {
    for (const part of parts) {
      const tag = part.nodeName;
      if (typeof part === 'string' || tag === '#text') write(part.textContent ?? part, level, look);
      else if (tag === 'SUB') walk([...part.childNodes], level + 3, { ...look, 'font-size': 9 });
      else if (tag === 'SUP') walk([...part.childNodes], level - 4, { ...look, 'font-size': 9 });
      else walk([...part.childNodes], level, tag === 'I' ? { ...look, 'font-style': 'italic' } : look);
    }
  };
  walk(withMath(text), 0, {});
  return made;
}

// About `count` round numbers between low and high.
function roundTicks(low, high, count) {
  const raw = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 5, 10].find(factor => factor * power >= raw * 0.999);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high * (1 + 1e-12) + 1e-300; ++i) ticks.push(Number((i * step).toPrecision(12)));
  return ticks;
}

// Texts of the ticks of an axis, all with the decimals of the finest: 0.0, 0.5, 1.0. From a million on and below
// a thousandth with a power of ten, because zeros would have to be counted.
function tickLabels(ticks) {
  const largest = Math.max(0, ...ticks.map(Math.abs));
  const power = largest >= 1e6 || (largest > 0 && largest < 1e-3) ? Math.floor(Math.log10(largest)) : 0;
  const scaled = ticks.map(tick => Number((tick / 10 ** power).toPrecision(9)));
  const decimals = Math.max(0, ...scaled.map(tick => (String(tick).split('.')[1] ?? '').length));
  const written = [...String(power)].map(one => (one === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[one])).join('');
  return scaled.map(tick => {
    const digits = tick.toFixed(decimals).replace('-', '−');
    return power && tick ? `${digits}×10${written}` : digits;
  });
}
