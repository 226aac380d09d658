// Panels over time. All show the same part of the trial and mark the same time under the pointer.
class TimePlots {
  static kMaxRows = 20000;  // more rows are drawn as minimum and maximum of groups, with finer groups in the
                            // view

  static kMarkLine = 11;  // pixels between the labels of two marks

  static kShaded = ['compression', 'extension', 'fault'];

  static kGapRows = 30;  // a line ends if a channel has no value for more rows

  constructor(data, container, folded, onHover, onView) {
    this.data = data;
    this.onHover = onHover;
    this.onView = onView;
    this.thinned = data.time.length > TimePlots.kMaxRows;
    this.rowIndex = this.groupRows(data.time[0], data.time[data.time.length - 1]);
    this.busy = false;
    this.plots = [];
    for (const panel of data.panels || PANELS) {
      const series = panel.series.filter(entry => data.columns[entry.channel]);
      if (series.length) this.plots.push(this.makePlot(panel, series, panel.folded ? folded : container));
    }
    for (const part of [container, folded]) {
      if (part.childElementCount) part.append(element('div', { className: 'axis-label' }, data.time_label || 'time since release, s'));
      else part.parentElement.hidden = true;
    }
    theme.redraw.push(() => this.redraw());
    const resized = new ResizeObserver(() => this.redraw());
    resized.observe(container);
    resized.observe(folded);
  }

  makePlot(panel, series, container) {
    const entries = series.map(entry => ({ ...entry, shown: entry.shown !== false }));
    const caption = element('figcaption', {}, element('b', {}, `${panel.title} `, element('span', {}, panel.unit)));
    const area = element('div', { className: panel.tall ? 'plot tall' : 'plot' });
    const cursor = element('div', { className: 'cursor' });
    container.append(element('figure', { className: 'panel' }, caption, area));
    const plot = { panel, series: entries, cursor };
    plot.legend = new Legend(caption, entries, (i, shown) => plot.graph.setVisibility(i, shown));
    plot.rows = this.rowsOf(plot);
    plot.graph = new Dygraph(area, plot.rows, {
      labels: ['t', ...entries.map(entry => entry.label)],
      series: Object.fromEntries(entries.map(entry => [entry.label, TimePlots.stroke(entry)])),
      visibility: entries.map(entry => entry.shown),
      legend: 'never',
      connectSeparatedPoints: true,
      highlightCircleSize: 3,
      xRangePad: 0,
      // The first panel has the labels of the marks, one per line.
      yRangePad: this.plots.length ? 6 : 16 + TimePlots.kMarkLine * Math.max(0, (this.data.marks || []).length - 1),
      axisLabelFontSize: 11,
      axes: {
        x: { pixelsPerLabel: 70, axisLabelFormatter: (t, granularity, options, graph) => t.toFixed(TimePlots.digits(graph)) },
        y: { axisLabelWidth: 54, pixelsPerLabel: 17, axisLabelFormatter: value => String(Number(value.toPrecision(6))) },
      },
      ...this.colors(entries),
      underlayCallback: (context, box, graph) => this.drawPhases(context, box, graph, plot),
      drawCallback: (graph, initial) => { if (!initial) this.follow(graph); },
      highlightCallback: (event, t, points, row) => this.hover(t, row),
      unhighlightCallback: () => this.hover(null),
    });
    area.append(cursor);
    return plot;
  }

  static stroke(entry) {
    if (entry.style === 'steps') return { strokeWidth: 1.6, stepPlot: true };
    if (entry.style === 'points') return { strokeWidth: 0, drawPoints: true, pointSize: 1.2 };
    return { strokeWidth: entry.style === 'dashed' ? 1.2 : 1.6, strokePattern: entry.style === 'dashed' ? [5, 4] : null };
  }

  // Number of decimals of a time label that distinguishes neighbouring labels.
  static digits(graph) {
    const [from, to] = graph.xAxisRange();
    return Math.max(0, Math.min(4, 1 - Math.floor(Math.log10((to - from) / 1.2))));
  }

  colors(entries) {
    return {
      colors: entries.map(entry => theme.color(entry.color)),
      gridLineColor: theme.color('grid'),
      axisLineColor: theme.color('rule'),
    };
  }

  redraw() {
    this.hover(null);
    for (const plot of this.plots) {
      plot.graph.resize();
      plot.graph.updateOptions(this.colors(plot.series));
    }
  }

  // Groups of rows drawn as one: [first, count]. Groups are fine in the view and half of its width around it,
  // coarse elsewhere.
  groupRows(from, to) {
    const time = this.data.time;
    if (!this.thinned) return null;
    const margin = (to - from) / 2;
    const first = rowAt(time, from - margin);
    const last = rowAt(time, to + margin);
    const groups = [];
    const add = (start, end, most) => {
      const count = Math.max(1, Math.ceil((2 * (end - start)) / most));
      for (let row = start; row < end; row += count) groups.push([row, Math.min(count, end - row)]);
    };
    add(0, first, TimePlots.kMaxRows / 8);
    add(first, last, TimePlots.kMaxRows);
    add(last, time.length, TimePlots.kMaxRows / 8);
    return groups;
  }

  rowsOf(plot) {
    const time = this.data.time;
    const columns = plot.series.map(entry => this.data.columns[entry.channel]);
    const scale = plot.panel.scale;
    const rows = [];
    const known = columns.map(() => -Infinity); // last row with a value
    // null: no sample yet, the line continues; NaN: no sample for long, the line ends.
    const none = (i, row) => (row - known[i] > TimePlots.kGapRows ? NaN : null);
    const groups = this.rowIndex || Array.from(time, (t, row) => [row, 1]);
    for (const [first, count] of groups) {
      const least = [time[first]];
      const greatest = [time[first + (count >> 1)]];
      columns.forEach((column, i) => {
        let low = Infinity;
        let high = -Infinity;
        for (let row = first; row < first + count; ++row) {
          if (column[row] < low) low = column[row];
          if (column[row] > high) high = column[row];
        }
        if (low <= high) known[i] = first + count - 1;
        least.push(low <= high ? low * scale : none(i, first));
        greatest.push(low <= high ? high * scale : none(i, first));
      });
      rows.push(least);
      if (count > 1) rows.push(greatest);
    }
    return rows;
  }

  // Makes the other panels follow one that the reader zoomed or moved.
  follow(graph) {
    if (this.busy) return;
    const [from, to] = graph.xAxisRange();
    const [shownFrom, shownTo] = this.range();
    if (from === shownFrom && to === shownTo) return;
    requestAnimationFrame(() => this.show(from, to));
  }

  range() {
    return this.view || [this.data.time[0], this.data.time[this.data.time.length - 1]];
  }

  show(from, to) {
    this.view = [from, to];
    this.hover(null);
    if (this.thinned) this.rowIndex = this.groupRows(from, to);
    this.busy = true;
    for (const plot of this.plots) {
      const options = { dateWindow: [from, to] };
      if (this.thinned) options.file = plot.rows = this.rowsOf(plot);
      plot.graph.updateOptions(options);
    }
    this.busy = false;
    this.onView(from, to);
  }

  // Resets heights that the reader set.
  unlockHeights() {
    for (const plot of this.plots) plot.graph.updateOptions({ valueRange: null }, true);
  }

  drawPhases(context, box, graph, plot) {
    context.save();
    context.beginPath();
    context.rect(box.x, box.y, box.w, box.h);
    context.clip();
    for (const phase of this.data.phases) {
      if (!TimePlots.kShaded.includes(phase.name)) continue;
      const left = graph.toDomXCoord(phase.from_s);
      context.fillStyle = theme.color(phase.name);
      context.fillRect(left, box.y, graph.toDomXCoord(phase.to_s) - left, box.h);
    }
    this.drawMarks(context, box, graph, plot);
    context.strokeStyle = context.fillStyle = theme.color('quiet');
    context.font = '10px system-ui, "DejaVu Sans", sans-serif';
    context.setLineDash([2, 3]);
    for (const stride of this.data.strides) {
      const width = graph.toDomXCoord(stride.liftoff_s ?? this.data.time[this.data.time.length - 1]) - graph.toDomXCoord(stride.touchdown_s);
      for (const [name, t] of [['touchdown', stride.touchdown_s], ['switch', stride.switch_s], ['liftoff', stride.liftoff_s]]) {
        if (t === null || (width < 12 && name !== 'touchdown')) continue;
        const x = Math.round(graph.toDomXCoord(t)) + 0.5;
        context.beginPath();
        context.moveTo(x, box.y);
        context.lineTo(x, box.y + box.h);
        context.stroke();
        if (width > 140 && (this.plots[0] || plot) === plot) context.fillText(name, x + 3, box.y + 9);
      }
    }
    context.restore();
  }

  // Draws the marked times, labelled in the first panel, and the limits of a panel.
  drawMarks(context, box, graph, plot) {
    context.save();
    context.strokeStyle = context.fillStyle = theme.color('bad');
    context.font = '10px system-ui, "DejaVu Sans", sans-serif';
    for (const [line, mark] of (this.data.marks || []).entries()) {
      const x = Math.round(graph.toDomXCoord(mark.time_s)) + 0.5;
      context.fillRect(x - 0.5, box.y, 1, box.h);
      if ((this.plots[0] || plot) === plot) context.fillText(mark.name, x + 4, box.y + 9 + TimePlots.kMarkLine * line);
    }
    context.setLineDash([6, 4]);
    for (const value of plot.panel.lines || []) {
      const y = Math.round(graph.toDomYCoord(value * plot.panel.scale)) + 0.5;
      context.beginPath();
      context.moveTo(box.x, y);
      context.lineTo(box.x + box.w, y);
      context.stroke();
      context.fillText('limit', box.x + box.w - 28, y - 3);
    }
    context.restore();
  }

  // Shows the time t, row `row` of the plotted rows, in every panel and legend; null: none.
  hover(t, row) {
    if (this.busy) return;
    this.busy = true;
    for (const plot of this.plots) {
      if (t === null) {
        plot.graph.clearSelection();
        plot.legend.show(null);
      } else {
        plot.graph.setSelection(row);
        plot.legend.show(plot.series.map((entry, i) => TimePlots.newest(plot.rows, row, i + 1)), plot.panel.digits);
        plot.cursor.style.left = `${plot.graph.toDomXCoord(t)}px`;
      }
      plot.cursor.style.display = t === null ? 'none' : 'block';
    }
    this.busy = false;
    this.onHover(t);
  }

  // The value of a column at a row, or the last one before it, because slow sensors have no value in most
  // rows.
  static newest(rows, row, column) {
    for (let back = row; back >= 0 && back > row - 50; --back) {
      if (rows[back][column] !== null) return rows[back][column];  // NaN counts, too: no value there
    }
    return null;
  }

  // Shows the row nearest to a time, as if the pointer were there.
  point(t) {
    if (t === null) { this.hover(null); return; }
    const rows = this.plots.length ? this.plots[0].rows : [];
    let low = 0;
    let high = rows.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (rows[middle][0] < t) low = middle + 1;
      else high = middle;
    }
    if (rows.length) this.hover(rows[low][0], low);
  }
}
