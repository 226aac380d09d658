// Quasi-static force of the ground over depth with its 95 % band, after the last visible stride, and the true
// curve of a simulated bed. Below the deepest point of the foot the curve is extrapolated and drawn thin.
class ProfileBand {
  constructor(data) {
    this.truth = data.bed_curve;
    this.curve = { label: 'strength profile', color: 'text', shown: true };
    this.truthEntry = { label: 'true bed', color: 'text', style: 'dashed', shown: true };
  }

  entries(strides) {
    const any = strides.some(stride => stride.profile);
    return [...(any ? [this.curve] : []), ...(any && this.truth ? [this.truthEntry] : [])];
  }

  static last(strides) {
    return strides.map(stride => stride.profile).filter(Boolean).pop();
  }

  // Largest force of what is drawn as known, so that the figure holds it.
  top(strides) {
    const profile = ProfileBand.last(strides);
    if (!profile) return 0;
    const most = (depths, forces) => forces.reduce((high, force, i) => (depths[i] <= profile.to_m ? Math.max(high, force) : high), 0);
    return Math.max(this.curve.shown ? most(profile.depth_m, profile.force_N) : 0,
      this.truth && this.truthEntry.shown ? most(this.truth.depth_m, this.truth.force_N) : 0);
  }

  draw(context, chart, strides) {
    const profile = ProfileBand.last(strides);
    if (!profile) return;
    if (this.curve.shown) this.drawBand(context, chart, profile);
    if (this.truthEntry.shown && this.truth) this.drawTruth(context, chart, profile);
  }

  drawBand(context, chart, profile) {
    const end = profile.depth_m.findLastIndex(depth => depth <= profile.to_m + 0.005) + 1;
    const x = i => chart.x(1000 * profile.depth_m[i]);
    context.beginPath();
    context.moveTo(chart.x(0), chart.y(0));
    for (let i = 0; i < end; ++i) context.lineTo(x(i), chart.y(profile.high_N[i]));
    for (let i = end - 1; i >= 0; --i) context.lineTo(x(i), chart.y(profile.low_N[i]));
    context.closePath();
    context.globalAlpha = 0.16;
    context.fillStyle = theme.color(this.curve.color);
    context.fill();
    context.globalAlpha = 1;
    context.strokeStyle = theme.color(this.curve.color);
    context.setLineDash([]);
    for (const guess of [false, true]) {
      context.lineWidth = guess ? 0.8 : 2;
      context.beginPath();
      let pen = !guess;
      if (pen) context.moveTo(chart.x(0), chart.y(0));
      for (let i = 0; i < end; ++i) {
        const here = profile.depth_m[i] > profile.to_m;
        if (here !== guess) continue;
        context[pen ? 'lineTo' : 'moveTo'](x(i), chart.y(profile.force_N[i]));
        pen = true;
      }
      context.stroke();
    }
  }

  drawTruth(context, chart, profile) {
    context.strokeStyle = theme.color(this.truthEntry.color);
    context.lineWidth = 1.2;
    context.setLineDash([5, 3]);
    context.beginPath();
    this.truth.depth_m.forEach((depth, i) => {
      if (depth > profile.to_m + 0.005) return;
      context[i ? 'lineTo' : 'moveTo'](chart.x(1000 * depth), chart.y(this.truth.force_N[i]));
    });
    context.stroke();
    context.setLineDash([]);
  }
}
