// Stiffness of every stride by the three treatments and the joint fit, with 95 % intervals where they are
// valid.
function drawStiffness(data, figure) {
  const fits = data.strides.flatMap(stride => TREATMENTS.map(treatment => stride[treatment.key]));
  const known = fits.filter(fit => fit.value_N_per_m !== null && fit.valid);
  if (!known.length) {
    figure.remove();
    return;
  }
  const caption = element('figcaption', {}, element('b', {}, 'Stiffness ', element('span', {}, 'N/m, with 95 % intervals')));
  const shown = TREATMENTS.map(treatment => ({ ...treatment, shown: true }));
  const svg = svgElement('svg', { role: 'img', 'aria-label': 'Stiffness of each stride' });
  // One unit of the drawing is one pixel, so that the text keeps its size.
  const draw = () => {
    const width = Math.round(svg.clientWidth);
    if (width > 100) drawIntervals(svg, data.strides, known, shown, width);
  };
  new Legend(caption, shown, draw, false);
  figure.append(caption, svg);
  new ResizeObserver(draw).observe(svg);
}

function drawIntervals(svg, strides, known, treatments, width) {
  const row = Math.max(4, Math.min(13, 260 / (strides.length * 4)));
  const height = strides.length * row * 4 + 30;
  const low = Math.min(...known.map(fit => fit.ci95_N_per_m[0]));
  const high = Math.max(...known.map(fit => fit.ci95_N_per_m[1]));
  const pad = 0.08 * (high - low || high);
  const x = value => 46 + ((value - low + pad) / (high - low + 2 * pad)) * (width - 60);
  svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
  svg.style.height = `${height}px`;
  svg.replaceChildren();
  const ticks = roundTicks(low - pad, high + pad, width / 60);
  tickLabels(ticks).forEach((label, i) => {
    const tick = ticks[i];
    svg.append(
      svgElement('line', { x1: x(tick), x2: x(tick), y1: 4, y2: height - 22, stroke: 'var(--grid)' }),
      svgText(label, { x: x(tick), y: height - 8, 'text-anchor': 'middle' }),
    );
  });
  strides.forEach((stride, i) => {
    const top = 8 + i * row * 4;
    if (row > 7 || i % Math.ceil(11 / (4 * row)) === 0) {
      svg.append(svgText(stride.number, { x: 34, y: top + row * 1.5 + 4, 'text-anchor': 'end' }));
    }
    treatments.forEach((treatment, j) => {
      if (treatment.shown) svg.append(...whisker(stride[treatment.key], treatment, x, top + j * row + row / 2));
    });
  });
  svg.append(svgText('stride', { transform: `translate(10 ${(height - 22) / 2}) rotate(-90)`, 'text-anchor': 'middle' }));
}

function whisker(fit, treatment, x, y) {
  if (fit.value_N_per_m === null || !fit.valid) return [];
  const color = `var(--${treatment.color})`;
  const [low, high] = fit.ci95_N_per_m;
  const dot = svgElement('circle', { cx: x(fit.value_N_per_m), cy: y, r: 3, fill: color });
  const title = svgElement('title');
  title.textContent = `${treatment.label}: ${fit.value_N_per_m.toFixed(0)} N/m (${low.toFixed(0)} to ${high.toFixed(0)})`;
  dot.append(title);
  return [svgElement('line', { x1: x(low), x2: x(high), y1: y, y2: y, stroke: color, 'stroke-width': 1.6 }), dot];
}
