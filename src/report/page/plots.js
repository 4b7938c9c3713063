// The two diagrams: history over time, tension along a line.
const FONT = '12px system-ui, -apple-system, "Segoe UI", "Liberation Sans", Arial, sans-serif';

function axis(label, size) {
  const values = (u, splits) => splits.map(v => String(+v.toPrecision(10)).replace("-", "−"));
  return { label, size, values, labelSize: 22, labelFont: FONT, font: FONT, stroke: css("--soft"), labelGap: 2,
    grid: { stroke: css("--rule"), width: 1 }, ticks: { stroke: css("--rule"), width: 1, size: 5 } };
}

const inUnit = values => values.map(v => (v === null ? null : v / data.unit.newtons));
const forceText = v => (v === null || v === undefined ? "–" : `${v.toFixed(data.unit.decimals)} ${data.unit.symbol}`);
const metreText = v => (v === null || v === undefined ? "–" : metres(v));

// What the history can show: axis label, how a value reads, and the curves.
const single = lines.length === 1;
const perLine = column => lines.filter(line => line.rows[column].length).map(line =>
  ({ label: line.name, color: line.color, values: line.rows[column] }));
const forces = column => perLine(column).map(curve => ({ ...curve, values: inUnit(curve.values) }));
const offset = (line, k, color) => ({ label: (single ? "" : line.name + " ") + "xyz"[k], color,
  values: line.rows["xyz"[k]].map(v => v - line.rows["xyz"[k]][0]) });
const QUANTITIES = [
  { name: "Fairlead tension", axis: `Tension at the fairlead [${data.unit.symbol}]`, text: forceText, curves: () => forces("tension") },
  { name: "Anchor tension", axis: `Tension at the anchor [${data.unit.symbol}]`, text: forceText, curves: () => forces("anchor") },
  { name: "Grounded length", axis: "Length on the bed [m]", text: metreText, curves: () => perLine("grounded") },
  { name: "Fairlead motion", axis: "Offset of the fairlead [m]", text: metreText,
    curves: () => lines.flatMap((line, i) => [0, 1, 2].map(k => offset(line, k, `--line-${((3 * i + k) % 8) + 1}`))) },
];

if (bodies.length) {
  const curves = (k, per) => bodies.flatMap((body, i) => [0, 1, 2].map(axis => ({
    label: `${body.name} ${"xyz"[axis]}`, color: `--line-${((3 * i + axis) % 8) + 1}`, values: body.loads[k + axis].map(v => v / per),
  })));
  const momentText = v => (v === null || v === undefined ? "–" : `${v.toFixed(data.unit.decimals)} ${data.unit.symbol} m`);
  QUANTITIES.push(
    { name: "Force on bodies", axis: `Force of the lines [${data.unit.symbol}]`, text: forceText, curves: () => curves(0, data.unit.newtons) },
    { name: "Moment on bodies", axis: `Moment of the lines [${data.unit.symbol} m]`, text: momentText, curves: () => curves(3, data.unit.newtons) },
    { name: "Motion of bodies", axis: "Offset [m]", text: metreText, curves: () => bodies.flatMap((body, i) => [0, 1, 2].map(axis => ({
      label: `${body.name} ${"xyz"[axis]}`, color: `--line-${((3 * i + axis) % 8) + 1}`, values: body.pose[axis].map(v => v - body.pose[axis][0]),
    }))) },
    { name: "Turns of bodies", axis: "Roll, pitch, yaw [deg]", text: v => (v === null || v === undefined ? "–" : `${v.toFixed(2)}°`),
      curves: () => bodies.flatMap((body, i) => ["roll", "pitch", "yaw"].map((name, axis) => ({
        label: `${body.name} ${name}`, color: `--line-${((3 * i + axis) % 8) + 1}`, values: body.pose[axis + 3].map(v => v * 180 / Math.PI),
      }))) },
  );
}
if (points.length) {
  QUANTITIES.push({ name: "Free points", axis: "Offset [m]", text: metreText, curves: () => points.flatMap((point, i) => [0, 1, 2].map(axis => ({
    label: `${point.name} ${"xyz"[axis]}`, color: `--line-${((3 * i + axis) % 8) + 1}`, values: point.place[axis].map(v => v - point.place[axis][0]),
  }))) });
}

function plotHeight(width) {
  return Math.round(Math.min(Math.max(width * 0.3, 220), 330));
}

function historyPlot(host, quantity, now, setTime) {
  const curves = quantity.curves();
  const width = host.clientWidth;
  const marker = u => {
    const x = Math.round(u.valToPos(now(), "x", true)) + 0.5;
    const { left, top, width, height } = u.bbox;
    if (!moving || x < left - 1 || x > left + width + 1) return;
    u.ctx.save();
    u.ctx.strokeStyle = css("--ink");
    u.ctx.setLineDash([4, 3]);
    u.ctx.lineWidth = devicePixelRatio;
    u.ctx.beginPath();
    u.ctx.moveTo(x, top);
    u.ctx.lineTo(x, top + height);
    u.ctx.stroke();
    u.ctx.restore();
  };
  const plot = new uPlot({
    width, height: plotHeight(width), padding: [8, 22, 0, 0],
    scales: { x: { time: false } },
    axes: [axis("Time [s]", 34), axis(quantity.axis, 62)],
    legend: { live: true },
    cursor: { drag: { x: true, y: false, dist: 6 }, points: { size: 7 } },
    series: [{ label: "t", value: (u, v) => (v === null || v === undefined ? "–" : seconds(v)) },
      ...curves.map(curve => ({ label: curve.label, stroke: css(curve.color), width: 1.5, value: (u, v) => quantity.text(v), points: { show: false } }))],
    hooks: { draw: [marker], ready: [u => setTimeout(() => legendAt(u, now()), 0)] },
  }, [data.time, ...curves.map(curve => curve.values)], host);
  // A press without a drag chooses the time.
  const across = event => event.clientX - plot.over.getBoundingClientRect().left;
  let pressed = null;
  plot.over.addEventListener("mousedown", event => { pressed = event.button === 0 ? across(event) : null; });
  plot.over.addEventListener("mouseup", event => {
    if (pressed !== null && Math.abs(across(event) - pressed) < 4) setTime(plot.posToVal(across(event), "x"));
    pressed = null;
  });
  // uPlot empties the legend when the pointer leaves; it then tells of the time of the shapes again.
  plot.over.addEventListener("mouseleave", () => setTimeout(() => legendAt(plot, now()), 0));
  return plot;
}

// Lets the legend tell the values of a time, unless the pointer asks for those of another.
function legendAt(plot, time) {
  if (plot.root.isConnected && !plot.over.matches(":hover")) plot.setLegend({ idx: plot.valToIdx(time) }, false);
}

// Least and largest tension of every node over the snapshots.
function envelope(line) {
  const low = Array.from(line.still.t), high = Array.from(line.still.t);
  for (const state of line.shapes) state.t.forEach((t, k) => { low[k] = Math.min(low[k], t); high[k] = Math.max(high[k], t); });
  return [low, high];
}

function alongPlot(host, line) {
  const width = host.clientWidth;
  const thin = (label, extra) => ({ label, value: (u, v) => forceText(v), points: { show: false }, width: 1, ...extra });
  const [low, high] = envelope(line);
  return new uPlot({
    width, height: plotHeight(width) - 30, padding: [8, 22, 0, 0],
    scales: { x: { time: false, range: [0, line.length] } },
    axes: [axis("Arc length from the fairlead [m]", 34), axis(`Tension [${data.unit.symbol}]`, 62)],
    cursor: { drag: { x: true, y: false, dist: 6 }, points: { size: 7 } },
    series: [{ label: "s", value: (u, v) => metreText(v) },
      thin("max", { stroke: css("--faint") }), thin("min", { stroke: css("--faint") }),
      thin("static", { stroke: css("--ghost"), dash: [6, 4], width: 1.5 }), thin("now", { stroke: css(line.color), width: 2 })],
    bands: [{ series: [1, 2], fill: css("--rule") + "80" }],
  }, [line.s, inUnit(high), inUnit(low), inUnit(Array.from(line.still.t)), inUnit(Array.from(line.still.t))], host);
}
