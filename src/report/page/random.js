// A random sea: the worst event, the spectrum and the exceedance of maxima, of one line and end at a time.
const random = { chosen: data.random[0], plots: [] };

function randomPlot(host, height, options, columns) {
  const width = element(host).clientWidth;
  random.plots.push(new uPlot({ width, height: Math.round(plotHeight(width) * height), padding: [8, 22, 0, 0], legend: { live: true },
    cursor: { drag: { x: true, y: false, dist: 6 }, points: { size: 7 } }, ...options }, columns, element(host)));
}

function drawRandom() {
  random.plots.splice(0).forEach(plot => plot.destroy());
  const of = random.chosen;
  if (!of) return;
  const color = css(lines[of.line].color), unit = data.unit;
  const curve = { stroke: color, width: 1.5, points: { show: false } };
  const still = name => ({ label: name, value: (u, v) => (v === null || v === undefined ? "–" : seconds(v)) });

  const highest = of.event[1].indexOf(Math.max(...of.event[1]));
  element("event-text").textContent = `${force(of.event[1][highest])} at ${seconds(of.event[0][highest])}`;
  randomPlot("event", 0.9, { scales: { x: { time: false } }, axes: [axis("Time [s]", 34), axis(`Tension [${unit.symbol}]`, 62)],
    series: [still("t"), { ...curve, label: of.end, value: (u, v) => forceText(v) }] }, [of.event[0], inUnit(of.event[1])]);

  const frequency = of.density.map((_, k) => k * of.step);
  const square = of.density.map(v => v / unit.newtons ** 2);
  const text = v => (v === null || v === undefined ? "–" : `${v.toPrecision(4)} ${unit.symbol}²/Hz`);
  randomPlot("spectrum", 0.9, { scales: { x: { time: false } }, axes: [axis("Frequency [Hz]", 34), axis(`Density [${unit.symbol}²/Hz]`, 72)],
    series: [{ label: "f", value: (u, v) => (v === null || v === undefined ? "–" : `${v.toFixed(4)} Hz, ${v > 0 ? (1 / v).toFixed(2) : "∞"} s`) },
      { ...curve, label: "density", fill: color + "22", value: (u, v) => text(v) }] }, [frequency, square]);

  // The law goes on beyond the maxima, to the most probable one of 3 h.
  const [scale, shape, threshold, offset, most, low, high] = of.law ?? [];
  const beyond = of.law ? Array.from({ length: 30 }, (_, k) => of.maxima.at(-1) + (k + 1) / 30 * Math.max(high - of.maxima.at(-1), 0.02 * high)) : [];
  const x = [...of.maxima, ...beyond];
  // Shares as powers of ten.
  const shares = [...of.exceedance.map(Math.log10), ...beyond.map(() => null)];
  const law = x.map(v => (of.law && v - of.mean >= threshold ? (offset - ((v - of.mean) / scale) ** shape) / Math.LN10 : null));
  const share = v => (v === null || v === undefined ? "–" : (10 ** v).toPrecision(3));
  element("maxima-text").textContent = of.law
    ? `most probable of 3 h ${force(most)} (90 %: ${force(low)} to ${force(high)}); Weibull shape ${shape.toPrecision(3)}${of.follows ? "" : ", which the maxima do not follow well"}`
    : "no law was fitted: too few maxima, or not those of a random sea";
  randomPlot("maxima", 1, { scales: { x: { time: false } },
    axes: [axis(`Maximum [${unit.symbol}]`, 34), { ...axis("Share that exceeds it", 62), values: (u, splits) => splits.map(v => (v % 1 === 0 ? String(+(10 ** v).toPrecision(1)) : "")) }],
    series: [{ label: "maximum", value: (u, v) => forceText(v) },
      { label: "maxima", stroke: color, paths: () => null, points: { show: true, size: 5, width: 1 }, value: (u, v) => share(v) },
      { label: "Weibull", stroke: css("--ink"), width: 1.5, points: { show: false }, value: (u, v) => share(v) }] },
  [inUnit(x), shares, law]);
}

if (data.random.length) {
  data.random.forEach((of, index) => option(element("end"), (single ? "" : `${lines[of.line].name}, `) + of.end, index));
  element("end").addEventListener("change", event => { random.chosen = data.random[event.target.value]; drawRandom(); });
}
