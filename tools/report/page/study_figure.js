// Points, lines, intervals and bands over two axes, as SVG.
class StudyFigure {
  static kMargin = { right: 14, top: 10, bottom: 42 };

  static kDigit = 6.6;  // width in pixels of a digit of a tick's label

  static kWordHeight = 18;  // pixels above the data for the label of a mark

  constructor(figure, panel, width) {
    this.figure = figure;
    this.height = 330;
    this.width = width;
    const caption = element('figcaption', {}, element('b', {}, ...withMath(figure.title)));
    panel.append(caption);
    this.groups = figure.series.map(() => svgElement('g'));
    if (figure.series.length > 1) {
      const entries = figure.series.map(series => ({ ...series, style: StudyFigure.swatch(series) }));
      new Legend(caption, entries.map(entry => Object.assign(entry, { label: withMath(entry.label) })), (i, shown) => { figure.series[i].shown = shown; this.draw(); }, false);
    }
    this.svg = svgElement('svg', { viewBox: `0 0 ${width} ${this.height}`, role: 'img', 'aria-label': withoutMath(figure.title) });
    this.reading = element('output');
    panel.append(this.svg, this.reading);
    if (figure.note) panel.append(element('p', {}, ...withMath(figure.note)));
    this.svg.onpointermove = event => this.hover(event);
    this.svg.onpointerleave = () => this.point(null);
    this.draw();
    new ResizeObserver(() => this.resize()).observe(this.svg);
  }

  // One unit of the drawing is one pixel, so that the text keeps its size on a narrow screen.
  resize() {
    const width = Math.round(this.svg.clientWidth);
    if (width < 200 || width === this.width) return;
    this.width = width;
    this.svg.setAttribute('viewBox', `0 0 ${width} ${this.height}`);
    this.draw();
  }

  static swatch(series) {
    if (series.mark === 'points') return series.hollow ? 'points hollow' : 'points';
    if (series.mark === 'band') return 'band';
    return series.dotted ? 'dotted' : series.dashed ? 'dashed' : 'line';
  }

  draw() {
    this.fit();
    this.svg.replaceChildren();
    this.drawAxes();
    const clip = svgElement('svg', { x: this.box.x, y: this.box.y, width: this.box.w, height: this.box.h,
      viewBox: `${this.box.x} ${this.box.y} ${this.box.w} ${this.box.h}` });
    for (const [at, word] of this.figure.marks) clip.append(...this.drawMark(at, word));
    for (const series of this.figure.series) if (series.shown) clip.append(this.drawSeries(series));
    if (this.empty) clip.append(svgText('no values', { x: this.box.x + this.box.w / 2, y: this.box.y + this.box.h / 2, 'text-anchor': 'middle' }));
    this.mark = svgElement('circle', { r: 5, fill: 'none', stroke: 'var(--text)', 'stroke-width': 1.5, visibility: 'hidden' });
    clip.append(this.mark);
    this.svg.append(clip);
  }

  // Zooms to all visible values and intervals, with a margin.
  fit() {
    const { log_x, log_y, categories } = this.figure;
    const shown = this.figure.series.filter(series => series.shown);
    this.empty = !shown.some(series => series.y.some(value => value !== null));
    this.xRange = StudyFigure.range(shown.flatMap(series => series.x), log_x);
    this.yRange = StudyFigure.range(shown.flatMap(series => [...series.y, ...series.low, ...series.high]), log_y);
    if (categories.length) this.xRange = [-0.5, categories.length - 0.5];
    const margin = StudyFigure.kMargin;
    const h = this.height - margin.top - margin.bottom;
    if (this.figure.marks.length) this.yRange[1] += ((this.yRange[1] - this.yRange[0]) * StudyFigure.kWordHeight) / (h - StudyFigure.kWordHeight);
    // Space for the tick labels, to the right of the axis' name.
    const longest = Math.max(0, ...StudyFigure.labels(StudyFigure.ticks(this.yRange, log_y, h / 38), log_y).map(label => label.length));
    const left = Math.max(48, 30 + StudyFigure.kDigit * longest);
    this.box = { x: left, y: margin.top, w: this.width - left - margin.right, h };
  }

  static range(values, log) {
    const known = values.filter(value => value !== null && (!log || value > 0)).map(value => (log ? Math.log10(value) : value));
    if (!known.length) return [0, 1];
    let low = known.reduce((a, b) => Math.min(a, b));
    let high = known.reduce((a, b) => Math.max(a, b));
    const pad = high > low ? 0.05 * (high - low) : Math.abs(high) * 0.1 || 0.5;
    if (!log && low >= 0 && low < 0.3 * high) low = pad * 0.6;
    return [low - pad, high + pad];
  }

  x(value) {
    const v = this.figure.log_x ? Math.log10(value) : value;
    return this.box.x + ((v - this.xRange[0]) / (this.xRange[1] - this.xRange[0])) * this.box.w;
  }

  y(value) {
    const v = this.figure.log_y ? Math.log10(value) : value;
    return this.box.y + ((this.yRange[1] - v) / (this.yRange[1] - this.yRange[0])) * this.box.h;
  }

  static ticks([low, high], log, count) {
    if (!log) return roundTicks(low, high, count);
    const all = [];
    for (let power = Math.floor(low); power <= high; ++power) {
      for (const factor of high - low > 3 ? [1] : high - low > 1.2 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 6, 8]) {
        const at = power + Math.log10(factor);
        if (at >= low && at <= high) all.push(Number((factor * 10 ** power).toPrecision(6)));
      }
    }
    return all;
  }

  // On a logarithmic axis each tick has its own decimals: 0.5, 10, 200.
  static labels(ticks, log) {
    return log ? ticks.flatMap(tick => tickLabels([tick])) : tickLabels(ticks);
  }

  drawAxes() {
    const { box, figure } = this;
    const grid = { stroke: 'var(--grid)' };
    const names = figure.categories;
    const xs = names.length ? names.map((_, i) => i) : StudyFigure.ticks(this.xRange, figure.log_x, box.w / 58);
    const labels = names.length ? names : StudyFigure.labels(xs, figure.log_x);
    const skip = names.length ? Math.ceil(names.length / (box.w / (8 * Math.max(...names.map(name => name.length)) + 8))) : 1;
    xs.forEach((tick, i) => {
      const x = this.x(tick);
      this.svg.append(svgElement('line', { x1: x, x2: x, y1: box.y, y2: box.y + box.h, ...grid }));
      if (i % skip === 0) this.svg.append(svgText(labels[i], { class: 'tick-x', x, y: box.y + box.h + 16, 'text-anchor': 'middle' }));
    });
    const ys = StudyFigure.ticks(this.yRange, figure.log_y, box.h / 38);
    StudyFigure.labels(ys, figure.log_y).forEach((label, i) => {
      const y = this.y(ys[i]);
      this.svg.append(svgElement('line', { x1: box.x, x2: box.x + box.w, y1: y, y2: y, ...grid }));
      this.svg.append(svgText(label, { class: 'tick-y', x: box.x - 7, y: y + 4, 'text-anchor': 'end' }));
    });
    this.svg.append(
      svgElement('rect', { x: box.x, y: box.y, width: box.w, height: box.h, fill: 'none', stroke: 'var(--rule)' }),
      svgEquation(figure.x_label, { x: box.x + box.w / 2, y: this.height - 8, 'text-anchor': 'middle' }),
      svgEquation(figure.y_label, { transform: `translate(14 ${box.y + box.h / 2}) rotate(-90)`, 'text-anchor': 'middle' }),
    );
  }

  drawMark(at, word) {
    const x = this.x(at);
    return [
      svgElement('line', { x1: x, x2: x, y1: this.box.y, y2: this.box.y + this.box.h, stroke: 'var(--quiet)', 'stroke-dasharray': '2 3' }),
      x > this.box.x + 0.7 * this.box.w
        ? svgEquation(word, { x: x - 4, y: this.box.y + 13, 'text-anchor': 'end' })
        : svgEquation(word, { x: x + 4, y: this.box.y + 13 }),
    ];
  }

  drawSeries(series) {
    const group = svgElement('g', { class: 'series', 'data-label': series.label });
    const color = colorOf(series);
    const known = i => series.x[i] !== null && series.y[i] !== null && !(this.figure.log_x && series.x[i] <= 0) && !(this.figure.log_y && series.y[i] <= 0);
    const indices = series.x.map((_, i) => i).filter(known);
    if (series.mark === 'band') group.append(this.area(series, indices, color));
    if (series.mark !== 'points') group.append(this.line(series, known, color));
    if (series.mark === 'points' || series.mark === 'line_and_points') {
      const radius = indices.length > 400 ? 1.6 : indices.length > 60 ? 2.3 : 3.2;
      for (const i of indices) {
        if (series.low.length) group.append(this.interval(series, i, color));
        const look = series.hollow && series.mark === 'points'
          ? { fill: 'none', stroke: color, 'stroke-width': 1.3 }
          : { fill: color, 'fill-opacity': indices.length > 60 ? 0.6 : 0.9 };
        group.append(svgElement('circle', { cx: this.x(series.x[i]), cy: this.y(series.y[i]), r: radius, ...look }));
      }
    }
    return group;
  }

  interval(series, i, color) {
    if (series.low[i] === null || series.high[i] === null) return svgElement('g');
    const x = this.x(series.x[i]);
    return svgElement('line', { x1: x, x2: x, y1: this.y(series.low[i]), y2: this.y(series.high[i]), stroke: color, 'stroke-width': 1.4, 'stroke-opacity': 0.8 });
  }

  line(series, known, color) {
    let path = '';
    let pen = false;
    for (let i = 0; i < series.x.length; ++i) {
      if (known(i)) path += `${pen ? 'L' : 'M'}${this.x(series.x[i]).toFixed(1)} ${this.y(series.y[i]).toFixed(1)}`;
      pen = known(i);
    }
    return svgElement('path', { d: path, fill: 'none', stroke: color, 'stroke-width': 1.7, 'stroke-dasharray': series.dotted ? '2 3' : series.dashed ? '7 4' : 'none' });
  }

  area(series, indices, color) {
    const there = indices.map(i => `${this.x(series.x[i]).toFixed(1)} ${this.y(series.high[i]).toFixed(1)}`);
    const back = indices.map(i => `${this.x(series.x[i]).toFixed(1)} ${this.y(series.low[i]).toFixed(1)}`).reverse();
    return svgElement('polygon', { points: [...there, ...back].join(' '), fill: color, 'fill-opacity': 0.16 });
  }

  hover(event) {
    const frame = this.svg.getBoundingClientRect();
    const px = ((event.clientX - frame.left) / frame.width) * this.width;
    const py = ((event.clientY - frame.top) / frame.height) * this.height;
    let best = 500;
    let nearest = null;
    for (const series of this.figure.series) {
      if (!series.shown) continue;
      for (let i = 0; i < series.x.length; ++i) {
        if (series.x[i] === null || series.y[i] === null) continue;
        const distance = (this.x(series.x[i]) - px) ** 2 + (this.y(series.y[i]) - py) ** 2;
        if (distance < best) [best, nearest] = [distance, { series, i }];
      }
    }
    this.point(nearest);
  }

  point(nearest) {
    this.mark.setAttribute('visibility', nearest ? 'visible' : 'hidden');
    this.reading.textContent = '';
    if (!nearest) return;
    const { series, i } = nearest;
    this.mark.setAttribute('cx', this.x(series.x[i]));
    this.mark.setAttribute('cy', this.y(series.y[i]));
    const shown = value => Number(value.toPrecision(4)).toString();
    const name = this.figure.categories[Math.round(series.x[i])] ?? shown(series.x[i]);
    const interval = series.low.length && series.low[i] !== null ? ` (${shown(series.low[i])} to ${shown(series.high[i])})` : '';
    this.reading.textContent = `${withoutMath(series.label)}: ${name}, ${shown(series.y[i])}${interval}`;
  }
}
