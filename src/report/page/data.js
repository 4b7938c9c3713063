// What the run left in the page, decoded: numbers are stored as integers of a quantum q.
const data = JSON.parse(document.getElementById("data").textContent);
const decode = ({ q, v }) => v.map(n => (n === null ? null : n * q));

const lines = data.lines.map((line, index) => ({
  ...line,
  color: `--line-${(index % 8) + 1}`,
  rows: Object.fromEntries(Object.entries(line.rows).map(([name, column]) => [name, decode(column)])),
  still: shape(line.still),
  shapes: line.shapes.map(shape),
}));

const bodies = data.bodies.map((body, index) => ({
  ...body, color: `--line-${((lines.length + index) % 8) + 1}`, pose: body.pose.map(decode), loads: body.loads.map(decode),
}));
const points = data.points.map(point => ({ ...point, place: point.place.map(decode) }));

// The edges of a body at a time, in global axes.
function bodyAt(body, time) {
  const { time: times } = data;
  if (!body.pose[0].length) return [];
  let j = times.findIndex(t => t >= time);
  if (j < 0) j = times.length - 1;
  const i = Math.max(j - 1, 0);
  const w = i === j ? 1 : (time - times[i]) / (times[j] - times[i]);
  const [x, y, z, roll, pitch, yaw] = body.pose.map(values => values[i] + w * (values[j] - values[i]));
  const [[sr, cr], [sp, cp], [sy, cy]] = [roll, pitch, yaw].map(angle => [Math.sin(angle), Math.cos(angle)]);
  const place = ([a, b, c]) => [
    x + cy * cp * a + (cy * sp * sr - sy * cr) * b + (cy * sp * cr + sy * sr) * c,
    y + sy * cp * a + (sy * sp * sr + cy * cr) * b + (sy * sp * cr - cy * sr) * c,
    z - sp * a + cp * sr * b + cp * cr * c,
  ];
  return body.edges.map(edge => edge.map(place));
}

// One state of a line: flat positions x0, y0, z0, x1, … and unit tangents alike, and the tension of each node.
function shape({ p, d, t }) {
  const times = (list, quantum) => Float64Array.from(list, n => n * quantum);
  return { p: times(p, data.length_quantum), d: times(d, data.tangent_quantum), t: times(t, data.force_quantum) };
}

// Lines whose equilibrium is known; a run that failed in statics knows some only.
const drawn = lines.filter(line => line.still.t.length > 1);
const moving = drawn.length > 0 && data.snapshot_times.length > 0;

// The state of a line at a time, between snapshots on the straight way from one to the next.
function stateAt(line, time) {
  if (!moving || line.shapes.length === 0) return { ...line.still, touchdown: null };
  const times = data.snapshot_times;
  let j = times.findIndex(t => t >= time);
  if (j < 0) j = times.length - 1;
  const i = Math.max(j - 1, 0);
  const w = i === j ? 1 : (time - times[i]) / (times[j] - times[i]);
  const blend = (a, b) => a.map((n, k) => n + w * (b[k] - n));
  const [a, b] = [line.touchdown[i], line.touchdown[j]];
  return {
    p: blend(line.shapes[i].p, line.shapes[j].p),
    d: blend(line.shapes[i].d, line.shapes[j].d),
    t: blend(line.shapes[i].t, line.shapes[j].t),
    touchdown: a === null || b === null ? null : a + w * (b - a),
  };
}

// Position within element j of a state, at the share w of its length: the cubic through both nodes along their tangents.
function within(line, { p, d }, j, w) {
  const h = line.s[j + 1] - line.s[j];
  const [b, e, f] = [w * w * (3 - 2 * w), w * (1 - w) ** 2 * h, w * w * (w - 1) * h];
  return [3 * j, 3 * j + 1, 3 * j + 2].map(k => p[k] + b * (p[k + 3] - p[k]) + e * d[k] + f * d[k + 3]);
}

// Position on a state at an arc length.
function pointAt(line, state, s) {
  const next = line.s.findIndex(t => t >= s);
  const j = next < 0 ? line.s.length - 2 : Math.max(next - 1, 0);
  return within(line, state, j, (s - line.s[j]) / (line.s[j + 1] - line.s[j]));
}

const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const element = id => document.getElementById(id);
const force = n => `${(n / data.unit.newtons).toFixed(data.unit.decimals)} ${data.unit.symbol}`;
const metres = n => `${n.toFixed(data.length_decimals)} m`;
const seconds = n => `${+n.toFixed(3)} s`;

function option(select, text, value) {
  const item = document.createElement("option");
  item.textContent = text;
  item.value = value;
  select.append(item);
}

// Colours of tension, low to high: told apart on paper, on a dark screen, and by most eyes.
const RAMP = [[46, 90, 150], [52, 143, 167], [110, 178, 132], [224, 178, 66], [205, 70, 45]];
function rampColor(fraction) {
  const x = Math.min(Math.max(fraction, 0), 1) * (RAMP.length - 1);
  const i = Math.min(Math.floor(x), RAMP.length - 2);
  return `rgb(${RAMP[i].map((c, k) => Math.round(c + (x - i) * (RAMP[i + 1][k] - c))).join(" ")})`;
}
const tensionRange = drawn.flatMap(line => [line.still, ...line.shapes]).reduce(
  ([low, high], state) => state.t.reduce(([a, b], t) => [Math.min(a, t), Math.max(b, t)], [low, high]), [Infinity, -Infinity]);
const tensionColor = t => rampColor((t - tensionRange[0]) / (tensionRange[1] - tensionRange[0] || 1));
