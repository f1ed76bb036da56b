"use strict";
// Puts the page's data into its figures, and the choices of record, level and layer into effect.
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const choice = { levels: new Set(), records: null, layers: new Set(["measured", "modelled"]), measured: "measured", modelled: "model" };
  const samples = data.samples;
  const loops = [];

  if (samples) {
    for (const name of Object.keys(samples.columns)) samples.columns[name] = erd.decode(samples.columns[name]);
    for (const name of ["level", "record", "joined"]) samples[name] = erd.decode(samples[name]);
    samples.levels.forEach((_, i) => choice.levels.add(i));
    Object.assign(choice, samples.words || {});
    choose(0);
  }

  function choose(i) {
    const { records } = samples.choices[i];
    choice.records = records && new Set(records);
  }

  for (const figure of document.querySelectorAll("figure[data-figure]")) {
    const spec = data.figures[figure.dataset.figure];
    const kind = spec.kind === "loops" ? erd.loops(spec, samples, choice) : erd[spec.kind](spec);
    if (spec.kind === "loops") loops.push(kind);
    new erd.Frame(figure, spec, kind);
  }

  const again = () => {
    for (const kind of loops) kind.choose();
    erd.redraw();
  };

  const colour = () => {
    const theme = erd.theme();
    for (const swatch of document.querySelectorAll("[data-swatch]")) {
      swatch.style.background = theme.level(samples.colours, +swatch.dataset.swatch);
    }
    for (const bar of document.querySelectorAll(".ramp")) {
      const map = data.figures[bar.closest("figure").dataset.figure];
      bar.style.background = `linear-gradient(to right, ${map.colours.join(",")})`;
    }
  };

  // A button that is on or off; the last one on of a set brings all others back.
  const toggles = (query, key, set, all) => {
    const buttons = [...document.querySelectorAll(query)];
    for (const button of buttons) {
      button.addEventListener("click", () => {
        const value = key(button);
        if (set.has(value)) set.delete(value);
        else set.add(value);
        if (!set.size) all().forEach((v) => set.add(v));
        for (const b of buttons) b.setAttribute("aria-pressed", set.has(key(b)));
        again();
      });
    }
  };
  toggles("button[data-level]", (b) => +b.dataset.level, choice.levels, () => samples.levels.map((_, i) => i));
  toggles("button[data-layer]", (b) => b.dataset.layer, choice.layers, () => ["measured", "modelled"]);
  const select = document.getElementById("records");
  if (select) select.addEventListener("change", () => { choose(+select.value); again(); erd.frames.forEach((frame) => frame.home()); });

  // Without a font made for formulas an index is not lowered: it then begins where its letter ends.
  const index = document.querySelector("math msub");
  if (index) {
    const [letter, low] = [...index.children].map((part) => part.getBoundingClientRect());
    const lowered = low.bottom > letter.bottom + 0.08 * letter.height;
    document.documentElement.classList.toggle("no-math-font", !lowered);
  }

  const all = () => { colour(); erd.redraw(); };
  erd.dark.addEventListener("change", all);
  // On paper: light colours, and figures as narrow as there, or their words would shrink.
  const print = (on) => {
    erd.printing = on;
    document.documentElement.classList.toggle("printing", on);
    colour();
    for (const frame of erd.frames) frame.resize(on ? 400 : undefined);
  };
  window.addEventListener("beforeprint", () => print(true));
  window.addEventListener("afterprint", () => print(false));
  colour();
  document.documentElement.dataset.ready = "true";
})();
