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

// About `count` round numbers between low and high.
function roundTicks(low, high, count) {
  const raw = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * [1, 2, 5, 10].find(factor => factor * power >= raw * 0.999);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high * (1 + 1e-12) + 1e-300; ++i) ticks.push(Number((i * step).toPrecision(12)));
  return ticks;
}
