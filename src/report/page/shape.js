// The line in space, seen from the side and from above, on canvases of our own.
const MARGIN = { left: 62, right: 14, top: 10, bottom: 36 };
const PIECES = 150;
const STRETCHES = [1, 1.5, 2, 3, 4, 5, 8, 10, 15, 20, 30, 40, 50, 80, 100, 150, 200, 300, 500];

// Vertical planes to look at: those of the lines, and those of the axes.
function planes() {
  const list = [];
  for (const line of drawn) {
    const [dx, dy] = [line.anchor[0] - line.fairlead[0], line.anchor[1] - line.fairlead[1]];
    const length = Math.hypot(dx, dy);
    if (length < 1e-6 * line.length) continue;
    const d = [dx / length, dy / length];
    if (Math.abs(d[0]) > 0.9999 || Math.abs(d[1]) > 0.9999) continue;
    const label = single ? "plane of the line" : `plane of ${line.name}`;
    list.push({ label, d, u: "along the plane", v: "across", spots: [line] });
  }
  const axes = [{ label: "x–z plane", d: [1, 0], u: "x", v: "y" }, { label: "y–z plane", d: [0, 1], u: "y", v: "−x" }];
  if (single) return drawn.length && Math.abs(lines[0].anchor[1] - lines[0].fairlead[1]) > Math.abs(lines[0].anchor[0] - lines[0].fairlead[0])
    ? [...list, axes[1], axes[0]] : [...list, ...axes];
  return [...axes, ...list];
}

// Bounds of what is to be seen, along a function of (x, y, z).
function bounds(states, of) {
  let low = Infinity, high = -Infinity;
  for (const { p } of states) for (let k = 0; k < p.length; k += 3) {
    const value = of(p[k], p[k + 1], p[k + 2]);
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return [low, high];
}

// Scales of a view `width` pixels wide: equal where wanted or where it fills the height, else stretched upwards by a round number.
function fit(width, [u0, u1], [v0, v1], tallest, wanted, equal) {
  const inner = width - MARGIN.left - MARGIN.right;
  const [du, dv] = [u1 - u0, v1 - v0];
  let scale = Math.min(inner / du, tallest / dv);
  const stretch = equal ? 1 : STRETCHES.filter(k => k * scale * dv <= wanted || k === 1).at(-1);
  const height = Math.max(dv * scale * stretch, 40);
  const left = MARGIN.left + (inner - du * scale) / 2;
  const middle = MARGIN.top + height / 2;
  return { stretch, width, height: height + MARGIN.top + MARGIN.bottom, inner, plotHeight: height,
    x: u => left + (u - u0) * scale, y: v => middle - (v - (v0 + v1) / 2) * scale * stretch,
    u: x => u0 + (x - left) / scale, v: y => (v0 + v1) / 2 - (y - middle) / (scale * stretch) };
}

function ticks(low, high, count) {
  const rough = (high - low) / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(k => k * power).find(k => k >= rough * 0.999);
  const list = [];
  for (let n = Math.ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; n += 1) list.push(+(n * step).toPrecision(10));
  return list;
}

function prepare(canvas, view) {
  const ratio = window.devicePixelRatio || 1;
  const [w, h] = [Math.round(view.width * ratio), Math.round(view.height * ratio)];
  if (canvas.width !== w || canvas.height !== h) {
    canvas.width = w;
    canvas.height = h;
    canvas.style.height = `${view.height}px`;
  }
  const c = canvas.getContext("2d");
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.clearRect(0, 0, view.width, view.height);
  c.font = FONT;
  c.lineJoin = c.lineCap = "round";
  return c;
}

function clipToPlot(c, view) {
  c.save();
  c.beginPath();
  c.rect(MARGIN.left, MARGIN.top, view.inner, view.plotHeight);
  c.clip();
}

function frame(c, view, uLabel, vLabel) {
  const right = MARGIN.left + view.inner, bottom = MARGIN.top + view.plotHeight;
  c.strokeStyle = css("--rule");
  c.fillStyle = css("--soft");
  c.lineWidth = 1;
  c.textAlign = "center";
  c.textBaseline = "top";
  for (const u of ticks(view.u(MARGIN.left), view.u(right), view.inner / 90)) {
    const x = Math.round(view.x(u)) + 0.5;
    c.beginPath(); c.moveTo(x, MARGIN.top); c.lineTo(x, bottom + 4); c.stroke();
    c.fillText(String(u).replace("-", "−"), x, bottom + 6);
  }
  c.textAlign = "right";
  c.textBaseline = "middle";
  for (const v of ticks(view.v(bottom), view.v(MARGIN.top), view.plotHeight / 44)) {
    const y = Math.round(view.y(v)) + 0.5;
    c.beginPath(); c.moveTo(MARGIN.left - 4, y); c.lineTo(right, y); c.stroke();
    c.fillText(String(v).replace("-", "−"), MARGIN.left - 8, y);
  }
  c.textAlign = "right";
  c.textBaseline = "bottom";
  c.fillText(`${uLabel} [m]`, right, view.height - 1);
  c.save();
  c.translate(11, MARGIN.top + view.plotHeight / 2);
  c.rotate(-Math.PI / 2);
  c.textAlign = "center";
  c.textBaseline = "middle";
  c.fillText(`${vLabel} [m]`, 0, 0);
  c.restore();
}

function polyline(c, view, p, project) {
  c.beginPath();
  for (let k = 0; k < p.length; k += 3) {
    const [u, v] = project(p[k], p[k + 1], p[k + 2]);
    c.lineTo(view.x(u), view.y(v));
  }
  c.stroke();
}

// The line in pieces short enough to look curved: their ends one after the other, each with the tension there.
function curve(line, state) {
  const points = [{ at: state.p.slice(0, 3), t: state.t[0] }];
  for (let j = 0; j + 1 < line.s.length; j += 1) {
    const pieces = Math.max(Math.ceil(PIECES * (line.s[j + 1] - line.s[j]) / line.length), 2);
    for (let k = 1; k <= pieces; k += 1) {
      const w = k / pieces;
      points.push({ at: within(line, state, j, w), t: state.t[j] + w * (state.t[j + 1] - state.t[j]) });
    }
  }
  return points;
}

function drawLine(c, view, points, project) {
  c.lineWidth = 3;
  points.slice(1).forEach((b, k) => {
    const a = points[k];
    c.strokeStyle = tensionColor((a.t + b.t) / 2);
    c.beginPath();
    for (const { at } of [a, b]) {
      const [u, v] = project(...at);
      c.lineTo(view.x(u), view.y(v));
    }
    c.stroke();
  });
}

function drawSpot(c, view, point, project, kind) {
  const [u, v] = project(...point);
  const [x, y] = [view.x(u), view.y(v)];
  c.lineWidth = 2;
  c.strokeStyle = css(kind === "touchdown" ? "--bed-edge" : "--ink");
  c.fillStyle = css(kind === "anchor" || kind === "body" ? "--ink" : "--paper");
  c.beginPath();
  if (kind === "fairlead" || kind === "body") c.arc(x, y, kind === "body" ? 3.5 : 4.5, 0, 2 * Math.PI);
  else if (kind === "anchor") c.rect(x - 4, y - 4, 8, 8);
  else { c.moveTo(x, y - 6); c.lineTo(x + 6, y); c.lineTo(x, y + 6); c.lineTo(x - 6, y); c.closePath(); }
  c.fill();
  c.stroke();
}

// Draws all lines into a view whose ground is painted already.
function drawLines(c, view, states, project) {
  drawn.forEach((line, i) => {
    c.setLineDash([6, 5]);
    c.strokeStyle = css("--ghost");
    c.lineWidth = 1.5;
    polyline(c, view, line.course, project);
    c.setLineDash([]);
    c.strokeStyle = css("--faint");
    c.lineWidth = 1.25;
    polyline(c, view, states[i].path, project);
  });
  drawn.forEach((line, i) => {
    drawLine(c, view, curve(line, states[i]), project);
    const last = line.s.length - 1;
    // Two nodes at one place: something acts there.
    for (let k = 0; k < last; k += 1) {
      if (line.s[k] === line.s[k + 1]) drawSpot(c, view, states[i].p.slice(3 * k, 3 * k + 3), project, "body");
    }
    if (states[i].touchdown !== null) drawSpot(c, view, pointAt(line, states[i], states[i].touchdown), project, "touchdown");
    drawSpot(c, view, states[i].p.slice(3 * last), project, "anchor");
    drawSpot(c, view, states[i].p.slice(0, 3), project, "fairlead");
  });
}

// Bodies as their edges.
function drawBodies(c, view, time, project) {
  c.setLineDash([]);
  c.lineWidth = 1.5;
  for (const body of bodies) {
    c.strokeStyle = css(body.color);
    for (const edge of bodyAt(body, time)) {
      c.beginPath();
      for (const place of edge) {
        const [u, v] = project(...place);
        c.lineTo(view.x(u), view.y(v));
      }
      c.stroke();
    }
  }
}

// The name of a line beside its anchor, on the side with room for it.
function drawName(c, view, line, anchor, project) {
  const [u, v] = project(...anchor);
  const x = view.x(u);
  const leftwards = x + 10 + c.measureText(line.name).width > MARGIN.left + view.inner;
  c.fillStyle = css(line.color);
  c.textAlign = leftwards ? "right" : "left";
  c.textBaseline = "bottom";
  c.fillText(line.name, x + (leftwards ? -9 : 9), view.y(v) - 5);
}

// A state with its way from equilibrium drawn `factor` times as long, and the fairlead's path likewise.
function magnified(line, state, factor) {
  const [p, d] = ["p", "d"].map(name => state[name].map((n, k) => line.still[name][k] + factor * (n - line.still[name][k])));
  const { x, y, z } = line.rows;
  const start = line.still.p.slice(0, 3);
  const path = new Float64Array(3 * x.length);
  x.forEach((_, i) => [x[i], y[i], z[i]].forEach((n, k) => { path[3 * i + k] = start[k] + factor * (n - start[k]); }));
  return { ...state, p, d, path };
}

// Both views in a plane: what they show is decided once, then drawn for any time.
class Shape {
  constructor(side, plan) {
    Object.assign(this, { side, plan, plane: planes()[0], equal: false, factor: 1 });
    for (const line of drawn) line.course = Float64Array.from(curve(line, line.still).flatMap(({ at }) => [...at]));
  }

  // Fits the scales to all that will be seen; to be called when width, plane, scales or magnification change.
  layout() {
    const width = this.side.parentElement.clientWidth;
    const [dx, dy] = this.plane.d;
    const all = drawn.flatMap(line => [line.still, ...line.shapes.map(state => magnified(line, state, this.factor))]);
    const along = bounds(all, (x, y) => x * dx + y * dy);
    const across = bounds(all, (x, y) => y * dx - x * dy);
    const height = bounds(all, (x, y, z) => z);
    const size = Math.max(along[1] - along[0], across[1] - across[0], height[1] - height[0]);
    const pad = ([low, high], share, least) => {
      const extra = Math.max((high - low) * share, (least - (high - low)) / 2);
      return [low - extra, high + extra];
    };
    const spots = drawn.flatMap(line => [line.fairlead, line.anchor]);
    this.through = [0, 1].map(k => spots.reduce((sum, p) => sum + p[k], 0) / spots.length);
    const u = pad(along, 0.03, 0.25 * size);
    const bed = u.map(value => this.bed(value));
    const seen = (level, far) => Math.abs(level - far) < 0.6 * size;
    if (seen(Math.min(...bed), height[0])) height[0] = Math.min(height[0], ...bed);
    if (seen(0, height[1])) height[1] = Math.max(height[1], 0);
    const tall = share => Math.min(Math.max(share * width, 110), share * 1000);
    this.sideView = fit(width, u, pad(height, 0.07, 0.02 * size), 460, tall(0.32), this.equal);
    this.planView = fit(width, u, pad(across, 0.12, 0.004 * size), 460, tall(0.19), this.equal);
    const told = view => (view.stretch === 1 ? "equal scales" : `vertical scale × ${view.stretch}`);
    const motion = this.factor === 1 ? "" : `, motion × ${this.factor}`;
    element("side-scale").textContent = told(this.sideView) + motion;
    element("plan-scale").textContent = told(this.planView).replace("vertical", "transverse") + motion;
  }

  // Height of the bed in the vertical plane through the middle of all ends.
  bed(u) {
    const [dx, dy] = this.plane.d;
    const [cx, cy] = this.through;
    const shift = u - (cx * dx + cy * dy);
    return -data.bed.depth + (cx + shift * dx) * data.bed.slope[0] + (cy + shift * dy) * data.bed.slope[1];
  }

  sideOf = (x, y, z) => [x * this.plane.d[0] + y * this.plane.d[1], z];
  planOf = (x, y) => [x * this.plane.d[0] + y * this.plane.d[1], y * this.plane.d[0] - x * this.plane.d[1]];

  draw(time) {
    this.time = time;
    this.states = drawn.map(line => magnified(line, stateAt(line, time), this.factor));
    this.drawSide();
    this.drawPlan();
  }

  drawSide() {
    const view = this.sideView;
    const c = prepare(this.side, view);
    const right = MARGIN.left + view.inner, bottom = MARGIN.top + view.plotHeight;
    const [uLeft, uRight] = [view.u(MARGIN.left), view.u(right)];
    const surface = view.y(0);
    clipToPlot(c, view);
    c.fillStyle = css("--water");
    c.fillRect(MARGIN.left, surface, view.inner, bottom - surface + 1e4);
    c.restore();
    frame(c, view, this.plane.u, "z");
    clipToPlot(c, view);
    c.strokeStyle = css("--surface");
    c.lineWidth = 1.5;
    c.beginPath(); c.moveTo(MARGIN.left, surface); c.lineTo(right, surface); c.stroke();
    c.fillStyle = css("--bed");
    c.strokeStyle = css("--bed-edge");
    c.beginPath();
    c.moveTo(MARGIN.left - 2, view.y(this.bed(uLeft)));
    c.lineTo(right + 2, view.y(this.bed(uRight)));
    c.stroke();
    c.lineTo(right + 2, bottom + 1e4);
    c.lineTo(MARGIN.left - 2, bottom + 1e4);
    c.fill();
    c.restore();
    drawBodies(c, view, this.time, this.sideOf);
    drawLines(c, view, this.states, this.sideOf);
  }

  drawPlan() {
    const view = this.planView;
    const c = prepare(this.plan, view);
    c.fillStyle = css("--water");
    c.fillRect(MARGIN.left, MARGIN.top, view.inner, view.plotHeight);
    frame(c, view, this.plane.u, this.plane.v);
    drawBodies(c, view, this.time, this.planOf);
    drawLines(c, view, this.states, this.planOf);
    if (!single) drawn.forEach(line => drawName(c, view, line, line.anchor, this.planOf));
  }

  // The node nearest to a point of a canvas, where it is near.
  nearest(canvas, x, y) {
    const [view, project] = canvas === this.side ? [this.sideView, this.sideOf] : [this.planView, this.planOf];
    let best = null, least = 18;
    drawn.forEach((line, i) => this.states[i].t.forEach((t, k) => {
      const [u, v] = project(...this.states[i].p.slice(3 * k, 3 * k + 3));
      const distance = Math.hypot(view.x(u) - x, view.y(v) - y);
      if (distance < least) [best, least] = [{ line, k }, distance];
    }));
    return best;
  }
}
