// Force against depth during the visible stances, with the lines fitted by the treatments.
class ForceDepth {
  static kPaths = [
    { channel: 'load_cell_force_N', label: 'load cell', color: 'green', shown: false },
    { channel: 'truth_contact_force_N', label: 'truth', color: 'text', style: 'dashed', depth: 'truth_foot_z_m', shown: false },
    { channel: 'quasi_static_force_N', label: 'quasi-static', color: 'orange' },
    { channel: 'estimate_contact_force_N', label: 'momentum observer', color: 'blue' },
  ];
  static kMargin = { left: 46, right: 12, top: 8, bottom: 34 };

  // onHover(t): called with the time of the nearest sample, or null.
  constructor(data, figure, onHover) {
    this.data = data;
    this.onHover = onHover;
    this.strides = data.strides;
    this.paths = ForceDepth.kPaths.filter(path => data.columns[path.channel])
      .map(path => ({ ...path, shown: path.shown !== false }));
    this.lines = TREATMENTS.map(treatment => ({ ...treatment, style: 'dashed', shown: true }));
    this.caption = element('figcaption', {}, element('b', {}, 'Force against depth ', this.scope = element('span')));
    this.band = new ProfileBand(data);
    const entries = [...this.band.entries(data.strides), ...this.paths, ...this.lines.map(line => Object.assign(line, { label: `fit: ${line.label}` }))];
    this.legend = new Legend(this.caption, entries, () => { this.fit(); this.draw(); }, false);
    this.canvas = element('canvas');
    figure.append(this.caption, this.canvas);
    this.collect();
    this.fit();
    theme.redraw.push(() => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    this.listen();
  }

  show(strides) {
    this.strides = strides;
    this.scope.textContent = strides.length === 1 ? `stride ${strides[0].number}` : `${strides.length} strides`;
    this.collect();
    this.fit();
    this.draw();
  }

  // Collects depth in mm, force in N and time of all samples of the stances, with a gap between two stances.
  collect() {
    const { time, columns } = this.data;
    for (const path of this.paths) {
      path.points = [];
      const forces = columns[path.channel];
      for (const stride of this.strides) {
        const end = rowAt(time, stride.liftoff_s ?? Infinity);
        for (let row = rowAt(time, stride.contact_s ?? stride.touchdown_s); row < end; ++row) {
          const depth = this.depthAt(path, row);
          if (!Number.isNaN(forces[row]) && !Number.isNaN(depth)) path.points.push([1000 * depth, forces[row], time[row]]);
        }
        path.points.push(null);
      }
    }
  }

  depthAt(path, row) {
    const { columns } = this.data;
    if (path.depth) return columns[path.depth] ? -columns[path.depth][row] : NaN;
    if (columns.force_depth_m) return columns.force_depth_m[row];
    return columns.estimate_foot_z_m ? -columns.estimate_foot_z_m[row] : NaN;
  }

  // Zooms to all visible samples.
  fit() {
    const view = { left: 0, right: 1, bottom: 0, top: 1 };
    for (const path of this.paths) {
      for (const point of path.shown ? path.points : []) {
        if (!point) continue;
        view.left = Math.min(view.left, point[0]);
        view.right = Math.max(view.right, point[0]);
        view.bottom = Math.min(view.bottom, point[1]);
        view.top = Math.max(view.top, point[1]);
      }
    }
    view.top = Math.max(view.top, this.band.top(this.strides));
    const pad = (low, high) => 0.05 * (high - low);
    const [dx, dy] = [pad(view.left, view.right), pad(view.bottom, view.top)];
    this.view = { left: view.left - dx, right: view.right + dx, bottom: view.bottom - dy, top: view.top + dy };
  }

  x(depth) {
    return this.box.x + ((depth - this.view.left) / (this.view.right - this.view.left)) * this.box.w;
  }

  y(force) {
    return this.box.y + ((this.view.top - force) / (this.view.top - this.view.bottom)) * this.box.h;
  }

  draw() {
    const ratio = devicePixelRatio || 1;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width) return;
    this.canvas.width = width * ratio;
    this.canvas.height = height * ratio;
    const margin = ForceDepth.kMargin;
    this.box = { x: margin.left, y: margin.top, w: width - margin.left - margin.right, h: height - margin.top - margin.bottom };
    const context = this.canvas.getContext('2d');
    context.scale(ratio, ratio);
    context.font = '11px system-ui, "DejaVu Sans", sans-serif';
    this.drawAxes(context);
    context.save();
    context.beginPath();
    context.rect(this.box.x, this.box.y, this.box.w, this.box.h);
    context.clip();
    this.band.draw(context, this, this.strides);
    this.drawPaths(context);
    this.drawLines(context);
    this.drawMarks(context);
    context.restore();
  }

  drawAxes(context) {
    const { box, view } = this;
    context.lineWidth = 1;
    context.strokeStyle = theme.color('grid');
    context.fillStyle = theme.color('quiet');
    context.textAlign = 'center';
    const depths = roundTicks(view.left, view.right, box.w / 60);
    tickLabels(depths).forEach((label, i) => {
      const x = Math.round(this.x(depths[i])) + 0.5;
      context.strokeRect(x, box.y, 0, box.h);
      context.fillText(label, x, box.y + box.h + 14);
    });
    context.fillText('depth, mm', box.x + box.w / 2, box.y + box.h + 29);
    context.textAlign = 'right';
    const forces = roundTicks(view.bottom, view.top, box.h / 34);
    tickLabels(forces).forEach((label, i) => {
      const y = Math.round(this.y(forces[i])) + 0.5;
      context.strokeRect(box.x, y, box.w, 0);
      context.fillText(label, box.x - 6, y + 4);
    });
    context.save();
    context.translate(11, box.y + box.h / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = 'center';
    context.fillText('force, N', 0, 0);
    context.restore();
    context.strokeStyle = theme.color('rule');
    context.strokeRect(box.x + 0.5, box.y + 0.5, box.w, box.h);
  }

  drawPaths(context) {
    for (const path of this.paths) {
      if (!path.shown) continue;
      context.strokeStyle = theme.color(path.color);
      context.lineWidth = 1.3;
      context.globalAlpha = this.strides.length > 3 ? 0.55 : 0.9;
      context.setLineDash(path.style === 'dashed' ? [4, 3] : []);
      context.beginPath();
      let pen = false;
      for (const point of path.points) {
        if (point) context[pen ? 'lineTo' : 'moveTo'](this.x(point[0]), this.y(point[1]));
        pen = point !== null;
      }
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  // The line of each treatment from the surface to the greatest depth; thin if the fit is not valid.
  drawLines(context) {
    for (const line of this.lines) {
      if (!line.shown) continue;
      context.strokeStyle = theme.color(line.color);
      for (const stride of this.strides) {
        const fit = stride[line.key];
        if (fit.value_N_per_m === null) continue;
        context.lineWidth = fit.valid ? 2.2 : 1;
        context.setLineDash(fit.valid ? [9, 4] : [2, 4]);
        context.beginPath();
        context.moveTo(this.x(0), this.y(fit.intercept_N));
        context.lineTo(this.x(1000 * stride.max_depth_m), this.y(fit.intercept_N + fit.value_N_per_m * stride.max_depth_m));
        context.stroke();
      }
    }
    context.setLineDash([]);
  }

  // Marks the stance switch on the observer's path, and the sample under the pointer.
  drawMarks(context) {
    const path = this.paths.find(candidate => candidate.channel === 'estimate_contact_force_N');
    if (path && path.shown) {
      for (const stride of this.strides) {
        const at = path.points.find(point => point && point[2] >= stride.switch_s);
        if (stride.switch_s !== null && at) this.dot(context, at, theme.color(path.color), this.strides.length > 1 ? '' : 'switch');
      }
    }
    if (this.nearest) this.dot(context, this.nearest, theme.color('text'), ForceDepth.reading(this.nearest));
  }

  static reading([depth, force]) {
    return `${depth.toFixed(1)} mm, ${force.toFixed(1)} N`;
  }

  dot(context, [depth, force], color, text) {
    const [x, y] = [this.x(depth), this.y(force)];
    context.beginPath();
    context.arc(x, y, 4, 0, 2 * Math.PI);
    context.fillStyle = theme.color('sheet');
    context.fill();
    context.strokeStyle = context.fillStyle = color;
    context.lineWidth = 1.6;
    context.stroke();
    const left = x > this.box.x + this.box.w * 0.7;
    context.textAlign = left ? 'right' : 'left';
    const at = x + (left ? -8 : 8);
    context.lineWidth = 4;
    context.lineJoin = 'round';
    context.strokeStyle = theme.color('sheet');  // background colour, so that the text is readable on the
                                                 // lines
    context.strokeText(text, at, y - 6);
    context.fillText(text, at, y - 6);
  }

  // Marks the sample of a time that was chosen in another plot.
  point(t) {
    const path = this.paths.find(candidate => candidate.shown && candidate.channel === 'estimate_contact_force_N');
    this.nearest = null;
    if (path && t !== null) {
      this.nearest = path.points.find(point => point && Math.abs(point[2] - t) < 0.0006) || null;
    }
    this.draw();
  }

  listen() {
    let start = null;
    const at = event => {
      const frame = this.canvas.getBoundingClientRect();
      return [event.clientX - frame.left, event.clientY - frame.top];
    };
    this.canvas.onpointerdown = event => {
      start = at(event);
      this.moved = { ...this.view };
      this.canvas.setPointerCapture(event.pointerId);
    };
    this.canvas.onpointermove = event => {
      if (!start) this.hover(...at(event));
      else if (event.shiftKey) this.pan(start, at(event));
      else this.rubberBand(start, at(event));
    };
    this.canvas.onpointerup = event => {
      if (start && !event.shiftKey) this.zoom(start, at(event));
      start = null;
    };
    this.canvas.onpointerleave = () => {
      this.nearest = null;
      this.draw();
      this.onHover(null);
    };
    this.canvas.ondblclick = () => {
      this.fit();
      this.draw();
    };
  }

  hover(px, py) {
    let best = 400; // squared pixels
    this.nearest = null;
    for (const path of this.paths) {
      if (!path.shown) continue;
      for (const point of path.points) {
        if (!point) continue;
        const distance = (this.x(point[0]) - px) ** 2 + (this.y(point[1]) - py) ** 2;
        if (distance < best) [best, this.nearest] = [distance, point];
      }
    }
    const nearest = this.nearest;
    this.onHover(nearest ? nearest[2] : null);
    this.nearest = nearest;
    this.draw();
  }

  pan([x0, y0], [x1, y1]) {
    const dx = ((x0 - x1) / this.box.w) * (this.moved.right - this.moved.left);
    const dy = ((y1 - y0) / this.box.h) * (this.moved.top - this.moved.bottom);
    this.view = {
      left: this.moved.left + dx, right: this.moved.right + dx, bottom: this.moved.bottom + dy, top: this.moved.top + dy,
    };
    this.draw();
  }

  rubberBand([x0, y0], [x1, y1]) {
    this.draw();
    const context = this.canvas.getContext('2d');
    context.fillStyle = theme.color('selection');
    context.fillRect(x0, y0, x1 - x0, y1 - y0);
  }

  zoom([x0, y0], [x1, y1]) {
    if (Math.abs(x1 - x0) < 6 || Math.abs(y1 - y0) < 6) return;
    const { box, view } = this;
    const depth = x => view.left + ((x - box.x) / box.w) * (view.right - view.left);
    const force = y => view.top - ((y - box.y) / box.h) * (view.top - view.bottom);
    this.view = {
      left: depth(Math.min(x0, x1)), right: depth(Math.max(x0, x1)),
      bottom: force(Math.max(y0, y1)), top: force(Math.min(y0, y1)),
    };
    this.draw();
  }
}
