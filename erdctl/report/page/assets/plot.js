"use strict";
// The frame that every figure shares: axes, zoom by wheel, drag, keys and buttons, a readout.
// Marks are drawn on a canvas (twenty thousand samples at once), axes and words as SVG.
const erd = {};

erd.dark = window.matchMedia("(prefers-color-scheme: dark)");
erd.printing = false;

erd.theme = () => {
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(name).trim();
  const dark = erd.dark.matches && !erd.printing;
  return {
    dark, ink: colour("--ink"), rule: colour("--rule"), muted: colour("--muted"), paper: colour("--paper"),
    before: colour("--before"), after: colour("--after"), band: colour("--band"),
    bad: colour("--bad"),
    // Colours come with the data, so that pictures and pages show a level alike.
    level: (colours, i) => colours[dark ? "dark" : "light"][i],
  };
};

// Base64 of little-endian numbers; the key names their type.
erd.decode = (coded) => {
  const kinds = { f4: Float32Array, f8: Float64Array, u1: Uint8Array, u4: Uint32Array };
  const [kind, text] = Object.entries(coded)[0];
  return new kinds[kind](Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
};

erd.number = (value) => {
  const text = Math.abs(value) >= 1e5 ? value.toExponential(3) : String(+value.toPrecision(4));
  return text.replace("-", "\u2212");
};
erd.label = (axis) => (axis.unit ? `${axis.label} [${axis.unit}]` : axis.label);

// 1, 2, 5 of each decade, while whole decades are in view.
erd.decades = (scale) => {
  const all = scale.ticks(), some = all.filter((v) => /^[125]/.test(v.toExponential()));
  return all.length > 8 && some.length > 2 ? some : all.slice(0, 10);
};

// Words on top of lines.
erd.write = (ctx, theme, text, x, y, align) => {
  Object.assign(ctx, { textAlign: align, lineWidth: 4, lineJoin: "round", strokeStyle: theme.paper, fillStyle: theme.muted });
  ctx.setLineDash([]);
  ctx.strokeText(text, x, y);
  ctx.fillText(text, x, y);
};

erd.frames = [];

erd.Frame = class {
  constructor(figure, spec, kind) {
    Object.assign(this, { figure, spec, kind, hit: null });
    this.place = figure.querySelector(".plot");
    this.canvas = this.place.appendChild(document.createElement("canvas"));
    this.svg = d3.select(this.place).append("svg").attr("aria-hidden", "true");
    this.tip = d3.select(this.place).append("output").attr("class", "tip").property("hidden", true);
    this.layers = {};
    for (const name of ["x", "y", "over"]) this.layers[name] = this.svg.append("g").attr("class", name);
    this.words = {
      x: this.svg.append("text").attr("class", "axis-label").attr("text-anchor", "end"),
      y: this.svg.append("text").attr("class", "axis-label"),
    };
    this.words.x.text(erd.label(spec.x));
    this.words.y.text(erd.label(spec.y));
    this.zoom = d3.zoom().scaleExtent([1, 400])
      // The wheel scrolls the page until the figure has been chosen; two fingers zoom, one scrolls.
      .filter((event) => {
        if (event.type === "wheel") return event.ctrlKey || this.chosen();
        return event.touches ? event.touches.length > 1 : !event.button;
      })
      .on("zoom", (event) => this.zoomed(event.transform));
    this.svg.call(this.zoom).on("dblclick.zoom", () => this.reset())
      .on("pointerdown", () => this.figure.focus({ preventScroll: true }))
      .on("pointermove", (event) => this.point(...d3.pointer(event)))
      .on("pointerleave", () => this.show(null));
    figure.addEventListener("keydown", (event) => this.key(event));
    figure.addEventListener("blur", () => this.show(null));
    for (const button of figure.querySelectorAll("button[data-key]")) {
      button.addEventListener("click", () => this.act(button.dataset.key));
    }
    this.transform = d3.zoomIdentity;
    erd.frames.push(this);
    this.resize();
    new ResizeObserver(() => this.place.clientWidth !== this.width && !erd.printing && this.resize())
      .observe(this.place);
  }

  chosen() { return document.activeElement === this.figure; }

  resize(width = this.place.clientWidth || 600) {
    this.width = width;
    const rows = this.kind.rows ? 70 + 30 * this.kind.rows : null;
    const tall = Math.max(230, Math.min(400, Math.round(this.width * 0.62)));
    this.height = rows || (this.figure.dataset.compact ? 210 : tall);
    this.inner = { left: this.kind.left || 52, right: this.width - 10, top: 26, bottom: this.height - 42 };
    const scale = Math.max(2, window.devicePixelRatio || 1); // sharp on paper, too
    this.canvas.width = this.width * scale;
    this.canvas.height = this.height * scale;
    this.scale = scale;
    this.svg.attr("viewBox", `0 0 ${this.width} ${this.height}`);
    this.words.x.attr("x", this.inner.right).attr("y", this.height - 6);
    this.words.y.attr("x", 2).attr("y", 14);
    const { left, right, top, bottom } = this.inner;
    this.zoom.extent([[left, top], [right, bottom]]).translateExtent([[left, top], [right, bottom]]);
    this.home();
  }

  // The axes at rest; kept when only colours or the choice of levels change.
  home() {
    const { left, right, top, bottom } = this.inner;
    const [x, y] = this.kind.extent();
    const make = (axis, range, ends) => {
      const scale = (axis.log ? d3.scaleLog() : d3.scaleLinear()).domain(ends).range(range);
      return axis.names || axis.log ? scale : scale.nice();
    };
    this.base = { x: make(this.spec.x, [left, right], x), y: make(this.spec.y, [bottom, top], y) };
    this.draw();
  }

  draw() {
    const theme = erd.theme();
    const x = this.transform.rescaleX(this.base.x);
    const y = this.transform.rescaleY(this.base.y);
    Object.assign(this, { x, y });
    const { left, right, top, bottom } = this.inner;
    const narrow = this.width < 420;
    const across = this.spec.x.log ? erd.decades(x) : x.ticks(narrow ? 5 : 8);
    const up = this.kind.yTicks ? this.kind.yTicks.values : y.ticks(this.height < 220 ? 4 : 6);
    this.layers.x.attr("transform", `translate(0,${bottom})`)
      .call(d3.axisBottom(x).tickValues(across).tickFormat(erd.number).tickSize(0).tickPadding(8));
    this.layers.y.attr("transform", `translate(${left},0)`)
      .call(d3.axisLeft(y).tickValues(up).tickFormat(this.kind.yTicks ? this.kind.yTicks.format : erd.number).tickSize(0).tickPadding(6));
    const ctx = this.canvas.getContext("2d");
    ctx.setTransform(this.scale, 0, 0, this.scale, 0, 0);
    ctx.clearRect(0, 0, this.width, this.height);
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, top, right - left, bottom - top);
    ctx.clip();
    ctx.fillStyle = theme.rule;
    for (const value of across) ctx.fillRect(x(value) - 0.5, top, 1, bottom - top);
    if (!this.kind.yTicks) for (const value of up) ctx.fillRect(left, y(value) - 0.5, right - left, 1);
    this.figure.dataset.drawn = this.kind.draw(ctx, x, y, theme, this.inner);
    ctx.restore();
    this.figure.dataset.view = JSON.stringify([...x.domain(), ...y.domain()]);
    this.show(this.hit);
  }

  zoomed(transform) {
    this.transform = transform;
    this.draw();
    const link = this.spec.link;
    if (!link || this.leading === false) return;
    for (const other of erd.frames) {
      if (other === this || other.spec.link !== link) continue;
      other.leading = false; // it follows, and must not lead back
      other.svg.call(other.zoom.transform, transform);
      other.leading = true;
    }
  }

  reset() { this.svg.call(this.zoom.transform, d3.zoomIdentity); }

  key(event) {
    if (event.target !== this.figure || event.ctrlKey || event.altKey || event.metaKey) return;
    if (this.act(event.key)) event.preventDefault();
  }

  act(key) {
    const stride = 0.15 * (this.inner.right - this.inner.left) / this.transform.k;
    const move = { ArrowLeft: [stride, 0], ArrowRight: [-stride, 0], ArrowUp: [0, stride], ArrowDown: [0, -stride] };
    if (key === "+" || key === "=") this.svg.call(this.zoom.scaleBy, 1.5);
    else if (key === "-") this.svg.call(this.zoom.scaleBy, 1 / 1.5);
    else if (key === "0" || key === "Home") this.reset();
    else if (key === "," || key === ".") this.show(this.kind.step(this.hit, key === "." ? 1 : -1, this.x, this.y, this.inner));
    else if (key === "Escape") this.show(null);
    // At rest the arrows scroll the page, as everywhere.
    else if (move[key] && this.transform.k > 1) this.svg.call(this.zoom.translateBy, ...move[key]);
    else return false;
    return true;
  }

  point(px, py) {
    const { left, right, top, bottom } = this.inner;
    const inside = px >= left && px <= right && py >= top && py <= bottom;
    this.show(inside ? this.kind.nearest(px, py, this.x, this.y) : null);
  }

  // hit: {x, y, text} in data units, or null.
  show(hit) {
    this.hit = hit;
    const marks = this.layers.over.selectAll("circle").data(hit && !hit.bare ? [hit] : []);
    marks.join("circle").attr("r", 5).attr("cx", (d) => this.x(d.x)).attr("cy", (d) => this.y(d.y));
    this.tip.property("hidden", !hit);
    if (!hit) return;
    this.tip.text(hit.text);
    const [px, py] = [this.x(hit.x), this.y(hit.y)];
    const box = this.tip.node();
    const zoom = this.place.clientWidth / this.width;
    const leftwards = px > this.width / 2;
    box.style.left = `${Math.max(0, leftwards ? px * zoom - box.offsetWidth - 12 : px * zoom + 12)}px`;
    box.style.top = `${Math.max(0, Math.min(py * zoom + 12, this.place.clientHeight - box.offsetHeight - 4))}px`;
  }
};

erd.redraw = () => erd.frames.forEach((frame) => frame.draw());
