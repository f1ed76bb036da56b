"use strict";
// What can be drawn in a frame: loops of samples, lines, a map. Each kind gives its extent, draws
// itself, and says what lies next to a point.
erd.span = (ends, values) => {
  for (const v of values) {
    if (v < ends[0]) ends[0] = v;
    if (v > ends[1]) ends[1] = v;
  }
  return ends;
};
erd.padded = ([low, high]) => (high > low ? [low, high] : [low - 1, high + 1]);
// Room for the marks at the edge.
erd.roomy = ([low, high]) => [low - 0.02 * (high - low), high + 0.02 * (high - low)];

// Samples coloured by PWM level: dots as measured, lines as modelled. `choice` holds for all loops.
erd.loops = (spec, samples, choice) => {
  const column = (name) => samples.columns[name];
  const x = column(spec.x.column), y = column(spec.y.column);
  const model = spec.model ? column(spec.model) : null;
  const forces = [y, ...samples.models.map(column)]; // so that figures side by side have one scale
  const visible = (i) => choice.levels.has(samples.level[i])
    && (!choice.records || choice.records.has(samples.record[i]));
  const count = samples.levels.length;
  let shown = [];
  const choose = () => {
    shown = [];
    for (let i = 0; i < x.length; i += 1) if (visible(i)) shown.push(i);
  };
  const describe = (i) => {
    const { x: a, y: b } = spec;
    const lines = [
      `PWM ${samples.levels[samples.level[i]]}, t = ${erd.number(samples.columns.t[i])} s`,
      `${a.label} ${erd.number(x[i])} ${a.unit}`,
      `${choice.measured} ${erd.number(y[i])} ${b.unit}`,
    ];
    if (model) lines.push(`${choice.modelled} ${erd.number(model[i])} ${b.unit}`, `difference ${erd.number(y[i] - model[i])} ${b.unit}`);
    return { x: x[i], y: y[i], text: lines.join("\n"), index: i };
  };
  choose();
  return {
    choose,
    extent() {
      const ends = [[Infinity, -Infinity], [Infinity, -Infinity]];
      for (const i of shown) {
        erd.span(ends[0], [x[i]]);
        for (const force of forces) erd.span(ends[1], [force[i]]);
      }
      return shown.length ? ends.map(erd.padded).map(erd.roomy) : [[0, 1], [0, 1]];
    },
    draw(ctx, sx, sy, theme) {
      const size = shown.length > 4000 ? 1.6 : 2.4;
      for (let level = 0; level < count; level += 1) {
        const colour = theme.level(samples.colours, level);
        if (choice.layers.has("measured")) {
          ctx.globalAlpha = shown.length > 4000 ? 0.4 : 0.55;
          ctx.fillStyle = colour;
          for (const i of shown) {
            if (samples.level[i] === level) ctx.fillRect(sx(x[i]) - size / 2, sy(y[i]) - size / 2, size, size);
          }
        }
      }
      for (let level = 0; model && choice.layers.has("modelled") && level < count; level += 1) {
        const colour = theme.level(samples.colours, level);
        ctx.globalAlpha = 1;
        ctx.lineWidth = 1.3;
        ctx.strokeStyle = ctx.fillStyle = colour;
        ctx.beginPath();
        let last = -2;
        for (const i of shown) {
          if (samples.level[i] !== level) continue;
          const px = sx(x[i]), py = sy(model[i]);
          if (last === i - 1 && samples.joined[i]) ctx.lineTo(px, py);
          else { ctx.moveTo(px - 0.6, py); ctx.lineTo(px + 0.6, py); ctx.moveTo(px, py); }
          last = i;
        }
        ctx.stroke();
      }
      return shown.length;
    },
    nearest(px, py, sx, sy) {
      let best = -1, least = 900; // within 30 pixels
      for (const i of shown) {
        const d = (sx(x[i]) - px) ** 2 + (sy(y[i]) - py) ** 2;
        if (d < least) { least = d; best = i; }
      }
      return best < 0 ? null : describe(best);
    },
    step(hit, way, sx, sy, inner) {
      const inside = (i) => sx(x[i]) >= inner.left && sx(x[i]) <= inner.right && sy(y[i]) >= inner.top && sy(y[i]) <= inner.bottom;
      const rows = shown.filter(inside);
      if (!rows.length) return null;
      const at = hit ? rows.findIndex((i) => i >= hit.index) : way > 0 ? -1 : 0;
      return describe(rows[(at + way + rows.length) % rows.length]);
    },
  };
};

// Several lines over one variable, with shaded intervals and levels to compare with.
erd.lines = (spec) => {
  const series = spec.series.map((s) => ({ ...s, x: erd.decode(s.x || spec.x.values), y: erd.decode(s.y) }));
  const dashes = [[], [6, 3], [2, 2], [8, 3, 2, 3]];
  const describe = (s, i) => ({
    x: s.x[i], y: s.y[i], index: i, series: s,
    text: `${s.words ? s.words[i] : s.name}\n${spec.x.label} ${erd.number(s.x[i])} ${spec.x.unit}\n${spec.y.label} ${erd.number(s.y[i])} ${spec.y.unit}`,
  });
  return {
    extent() {
      const ends = [[Infinity, -Infinity], spec.y.zero ? [0, 0] : [Infinity, -Infinity]];
      for (const s of series) {
        erd.span(ends[0], s.x);
        erd.span(ends[1], s.y);
      }
      for (const mark of spec.marks || []) erd.span(ends[1], [mark.value]);
      const [x, [low, high]] = ends.map(erd.padded);
      return [series.every((s) => s.words) ? [x[0] / 1.1, x[1] * 1.1] : x, [low, high + 0.04 * (high - low)]];
    },
    draw(ctx, sx, sy, theme, inner) {
      const words = [];
      ctx.font = "12px system-ui, sans-serif";
      for (const band of spec.bands || []) {
        const a = sx(Math.max(band.low, spec.x.log ? sx.domain()[0] : -Infinity)), b = sx(band.high);
        ctx.fillStyle = band.bad ? theme.bad : theme.band;
        ctx.globalAlpha = band.bad ? 0.35 : 1;
        ctx.fillRect(a, inner.top, Math.max(b - a, 1), inner.bottom - inner.top);
        ctx.globalAlpha = 1;
        if (band.text) words.push([band.text, Math.max(a, inner.left) + 4, inner.top + 14, "left"]);
      }
      for (const mark of spec.marks || []) {
        ctx.strokeStyle = ctx.fillStyle = theme.muted;
        ctx.setLineDash([2, 4]);
        ctx.beginPath();
        ctx.moveTo(inner.left, sy(mark.value));
        ctx.lineTo(inner.right, sy(mark.value));
        ctx.stroke();
        words.push([mark.text, inner.right - 4, sy(mark.value) - 5, "right"]);
      }
      const colours = series.length > 1 ? [theme.before, theme.after] : [theme.after];
      let drawn = 0;
      series.forEach((s, k) => {
        ctx.strokeStyle = ctx.fillStyle = colours[k % colours.length];
        ctx.lineWidth = k ? 1.8 : 1.6;
        ctx.setLineDash(dashes[(series.length - 1 - k) % 4]);
        ctx.beginPath();
        for (let i = 0; i < s.x.length; i += 1) {
          const px = sx(s.x[i]), py = sy(s.y[i]);
          if (s.style === "dots") ctx.fillRect(px - 3, py - 3, 6, 6);
          else if (s.style === "crosses") {
            for (const way of [-4, 4]) { ctx.moveTo(px - 4, py - way); ctx.lineTo(px + 4, py + way); }
          } else ctx.lineTo(px, py);
        }
        if (s.style === "crosses") ctx.setLineDash([]);
        if (s.style !== "dots") ctx.stroke();
        drawn += s.x.length;
      });
      for (const [text, px, py, align] of words) erd.write(ctx, theme, text, px, py, align);
      return drawn;
    },
    nearest(px, py, sx, sy) {
      let found = null, least = 1600;
      for (const s of series) {
        for (let i = 0; i < s.x.length; i += 1) {
          const d = (sx(s.x[i]) - px) ** 2 + (sy(s.y[i]) - py) ** 2;
          if (d < least) { least = d; found = [s, i]; }
        }
      }
      return found && describe(...found);
    },
    step(hit, way, sx) {
      const s = hit ? hit.series : series[series.length - 1];
      const [low, high] = sx.domain();
      let i = hit ? hit.index + way : d3.bisectLeft(s.x, low);
      if (i < 0 || i >= s.x.length || s.x[i] > high || s.x[i] < low) i = d3.bisectLeft(s.x, low);
      return describe(s, Math.min(i, s.x.length - 1));
    },
  };
};

// Root mean square misfit in cells of velocity and PWM level.
erd.map = (spec) => {
  const { edges } = spec.x, rows = spec.y.names, n = edges.length - 1;
  const last = spec.colours.length - 1;
  const heat = d3.scaleLinear().domain(spec.colours.map((_, i) => i / last)).range(spec.colours).clamp(true);
  const centre = (i, j) => ({
    x: (edges[j] + edges[j + 1]) / 2, y: i + 0.5, bare: true, index: i * n + j,
    text: `PWM ${rows[i]}\n${erd.number(edges[j])} to ${erd.number(edges[j + 1])} ${spec.x.unit}\n`
      + (spec.counts[i][j] ? `RMS misfit ${erd.number(spec.values[i][j])} N\n${spec.counts[i][j]} samples` : "no samples"),
  });
  return {
    rows: rows.length,
    left: 52,
    yTicks: { values: rows.map((_, i) => i + 0.5), format: (v) => rows[Math.floor(v)] },
    extent: () => [[edges[0], edges[n]], [0, rows.length]],
    draw(ctx, sx, sy, theme, inner) {
      let drawn = 0;
      ctx.fillStyle = theme.band; // what the log does not hold
      ctx.fillRect(inner.left, inner.top, inner.right - inner.left, inner.bottom - inner.top);
      for (let i = 0; i < rows.length; i += 1) {
        for (let j = 0; j < n; j += 1) {
          if (!spec.counts[i][j]) continue;
          ctx.fillStyle = heat(spec.values[i][j] / (spec.most || 1));
          const left = sx(edges[j]), top = sy(i + 1);
          ctx.fillRect(left, top + 1, sx(edges[j + 1]) - left + 0.5, sy(i) - top - 2);
          drawn += 1;
        }
      }
      return drawn;
    },
    nearest(px, py, sx, sy) {
      const i = Math.floor(sy.invert(py)), j = d3.bisectRight(edges, sx.invert(px)) - 1;
      return i >= 0 && i < rows.length && j >= 0 && j < n ? centre(i, j) : null;
    },
    step(hit, way) {
      const filled = spec.counts.flat().map((count, k) => (count ? k : -1)).filter((k) => k >= 0);
      const at = hit ? filled.indexOf(hit.index) : way > 0 ? -1 : 0;
      const k = filled[(at + way + filled.length) % filled.length];
      return centre(Math.floor(k / n), k % n);
    },
  };
};
