// The page at work: what is chosen, what time it is, and who draws what when either changes.
const state = { time: 0, quantity: QUANTITIES[0], line: drawn[0], playing: null };
const end = moving ? data.snapshot_times.at(-1) : 0;
let history = null, along = null, shapes = null;

function setTime(time) {
  state.time = Math.min(Math.max(time, 0), end);
  element("time").value = state.time;
  element("clock").textContent = `t = ${state.time.toFixed(data.time_decimals)} s`;
  if (shapes) shapes.draw(state.time);
  if (history) {
    history.redraw(false);
    legendAt(history, state.time);
  }
  if (along) {
    along.setData([...along.data.slice(0, 4), inUnit(Array.from(stateAt(state.line, state.time).t))], false);
    along.redraw(false);
  }
}

function drawHistory() {
  if (history) history.destroy();
  history = data.time.length ? historyPlot(element("history"), state.quantity, () => state.time, setTime) : null;
}

function drawAlong() {
  if (along) along.destroy();
  along = drawn.length ? alongPlot(element("along"), state.line) : null;
}

function drawAll() {
  drawHistory();
  drawAlong();
  drawRandom();
  if (shapes) shapes.layout();
  setTime(state.time);
}

function chooseQuantity() {
  for (const quantity of QUANTITIES) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = quantity.name;
    button.setAttribute("aria-pressed", quantity === state.quantity);
    button.addEventListener("click", () => {
      state.quantity = quantity;
      element("quantity").childNodes.forEach(other => other.setAttribute("aria-pressed", other === button));
      drawHistory();
      setTime(state.time);
    });
    element("quantity").append(button);
  }
}

function play() {
  const button = element("play");
  const stop = () => { cancelAnimationFrame(state.playing); state.playing = null; button.textContent = "▶"; button.ariaLabel = "Play"; };
  button.addEventListener("click", () => {
    if (state.playing !== null) return stop();
    button.textContent = "❚❚";
    button.ariaLabel = "Pause";
    if (state.time >= end) setTime(0);
    let before = null;
    const next = now => {
      if (before !== null) setTime(state.time + (now - before) / 1000 * element("speed").value);
      before = now;
      if (state.time >= end) return stop();
      state.playing = requestAnimationFrame(next);
    };
    state.playing = requestAnimationFrame(next);
  });
}

function chooseView() {
  const all = planes();
  all.forEach((plane, index) => option(element("plane"), plane.label, index));
  const relayout = change => event => { change(event.target); shapes.layout(); shapes.draw(state.time); };
  element("plane").addEventListener("change", relayout(select => { shapes.plane = all[select.value]; }));
  element("turn").addEventListener("input", relayout(slider => {
    const angle = slider.value * Math.PI / 180;
    shapes.plane = { label: "turned", d: [Math.cos(angle), Math.sin(angle)], u: `along ${slider.value}° from x`, v: "across" };
  }));
  element("equal").addEventListener("change", relayout(box => { shapes.equal = box.checked; }));
  element("magnify").addEventListener("change", relayout(select => { shapes.factor = +select.value; }));
  element("line").hidden = single;
  drawn.forEach((line, index) => option(element("line"), line.name, index));
  element("line").addEventListener("change", event => { state.line = drawn[event.target.value]; drawAlong(); setTime(state.time); });
}

function choosePlayer() {
  const slider = element("time");
  Object.assign(slider, { min: 0, max: end, step: "any" });
  slider.addEventListener("input", () => setTime(+slider.value));
  const worst = drawn.reduce((a, b) => ((b.extremes?.max ?? 0) > (a.extremes?.max ?? 0) ? b : a));
  if (worst.extremes) {
    element("at-max").addEventListener("click", () => setTime(worst.extremes.max_time));
    element("at-min").addEventListener("click", () => setTime(worst.extremes.min_time));
    state.time = worst.extremes.max_time;
  }
  play();
}

function pointAtNodes() {
  const tip = element("tip");
  for (const canvas of [element("side"), element("plan")]) {
    canvas.addEventListener("pointermove", event => {
      const found = shapes.nearest(canvas, event.offsetX, event.offsetY);
      tip.hidden = !found;
      if (!found) return;
      const { line, k } = found;
      const now = stateAt(line, state.time);
      const [x, y, z] = now.p.slice(3 * k, 3 * k + 3);
      tip.textContent = `${single ? "" : line.name + "\n"}s = ${metres(line.s[k])}\n(${metres(x)}, ${metres(y)}, ${metres(z)})\ntension ${force(now.t[k])}`;
      tip.style.left = `${Math.min(event.pageX + 14, document.documentElement.clientWidth - tip.offsetWidth - 6)}px`;
      tip.style.top = `${event.pageY + 14}px`;
    });
    canvas.addEventListener("pointerleave", () => { tip.hidden = true; });
  }
}

function theme() {
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const set = name => {
    document.documentElement.dataset.theme = name;
    element("theme").textContent = name === "dark" ? "light" : "dark";
  };
  set(dark.matches ? "dark" : "light");
  element("theme").addEventListener("click", () => { set(element("theme").textContent); drawAll(); });
  dark.addEventListener("change", () => { set(dark.matches ? "dark" : "light"); drawAll(); });
  // Paper is white, and narrower than most windows.
  let screen = null;
  window.addEventListener("beforeprint", () => {
    screen = document.documentElement.dataset.theme;
    set("light");
    document.querySelector("main").classList.add("printing");
    drawAll();
  });
  window.addEventListener("afterprint", () => { set(screen); document.querySelector("main").classList.remove("printing"); drawAll(); });
}

function resize() {
  let width = element("along-section").clientWidth;
  new ResizeObserver(() => {
    const now = element("along-section").clientWidth;
    if (now === width) return;
    width = now;
    // Not within the observer: what is drawn changes sizes, too.
    requestAnimationFrame(drawAll);
  }).observe(element("along-section"));
}

theme();
chooseQuantity();
if (!data.time.length) element("history-section").hidden = true;
if (drawn.length) {
  shapes = new Shape(element("side"), element("plan"));
  element("ramp").style.background = `linear-gradient(90deg, ${[0, 0.25, 0.5, 0.75, 1].map(rampColor).join(", ")})`;
  element("low").textContent = force(tensionRange[0]);
  element("high").textContent = force(tensionRange[1]);
  chooseView();
  choosePlayer();
  pointAtNodes();
} else {
  element("shape-section").hidden = element("along-section").hidden = true;
}
document.querySelectorAll("[data-line]").forEach(swatch => { swatch.style.background = `var(${lines[swatch.dataset.line].color})`; });
if (!moving) document.querySelector(".player").hidden = true;
drawAll();
resize();
