"use strict";
// Draws a report of prt, which the page contains as JSON (cli/report/report_page.cpp writes it).

/** Creates an element of HTML, or of SVG if `space` is that of SVG; children are elements and text. */
function element(name, attributes = {}, children = [], space = "http://www.w3.org/1999/xhtml") {
  const made = document.createElementNS(space, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

const svg = (name, attributes, children) => element(name, attributes, children, "http://www.w3.org/2000/svg");

const kColors = 8; // --series-0.. of page.html
const kWidth = 800, kHeight = 420, kLeft = 80, kRight = 190, kTop = 28, kBottom = 46;

/**
 * Creates a logarithmic axis over all values, with a margin: its mapping of values to `from`..`to`, and its
 * ticks.
 */
function logAxis(values, from, to) {
  const low = Math.min(...values) / 1.15, high = Math.max(...values) * 1.15;
  const place = (value) => from + (Math.log(value / low) / Math.log(high / low)) * (to - from);
  const ticks = []; // 1, 2 and 5 times the powers of ten
  for (let power = Math.floor(Math.log10(low)); 10 ** power <= high; ++power)
    for (const digit of [1, 2, 5]) {
      const tick = Number(`${digit}e${power}`);
      if (tick >= low && tick <= high) ticks.push(tick);
    }
  return { place, ticks };
}

function grid(x, y) {
  const lines = [];
  for (const tick of x.ticks) {
    const at = x.place(tick);
    lines.push(svg("line", { x1: at, x2: at, y1: kTop, y2: kHeight - kBottom, class: "grid" }));
    lines.push(svg("text", { x: at, y: kHeight - kBottom + 18, "text-anchor": "middle" }, [tick]));
  }
  for (const tick of y.ticks) {
    const at = y.place(tick);
    lines.push(svg("line", { x1: kLeft, x2: kWidth - kRight, y1: at, y2: at, class: "grid" }));
    lines.push(svg("text", { x: kLeft - 6, y: at + 4, "text-anchor": "end" }, [tick]));
  }
  return lines;
}

/** A curve with its points, and a line of the legend: a stroke in its color, the name as text. */
function curve(series, row, x, y) {
  const color = series.strong ? "var(--text)" : `var(--series-${row % kColors})`;
  const stroke = { class: series.strong ? "curve strong" : "curve", style: `stroke:${color}` };
  const line = series.points.map((point) => `${x.place(point.x)},${y.place(point.y)}`).join(" ");
  const left = kWidth - kRight + 12, middle = kTop + 10 + 22 * row;
  const dot = (point) =>
    svg("circle", {
      cx: x.place(point.x), cy: y.place(point.y), r: series.strong ? 5 : 3.5, style: `fill:${color}`,
    }, [svg("title", {}, [point.label])]);
  return [
    svg("polyline", { ...stroke, points: line }),
    ...series.points.map(dot),
    svg("line", { ...stroke, x1: left, x2: left + 22, y1: middle, y2: middle }),
    svg("text", { x: left + 30, y: middle + 4 }, [series.name]),
  ];
}

/** Draws curves over logarithmic axes, without points that are not above zero. */
function chart(data) {
  const all = data.series.map((s) => ({ ...s, points: s.points.filter((p) => p.x > 0 && p.y > 0) }));
  const points = all.flatMap((series) => series.points);
  const x = logAxis(points.map((point) => point.x), kLeft, kWidth - kRight);
  const y = logAxis(points.map((point) => point.y), kHeight - kBottom, kTop);
  return svg("svg", {
    viewBox: `0 0 ${kWidth} ${kHeight}`, role: "img", "aria-label": `${data.y_title} over ${data.x_title}`,
  }, [
    ...grid(x, y),
    svg("text", { x: (kLeft + kWidth - kRight) / 2, y: kHeight - 6, "text-anchor": "middle" }, [data.x_title]),
    svg("text", { x: kLeft, y: 16 }, [data.y_title]),
    ...all.flatMap((series, row) => curve(series, row, x, y)),
  ]);
}

/** A bar on its line: its name, its parts one behind the other, its value. */
function bar(data, series, line, scale) {
  const kName = 150, kLine = 30, top = kTop + 14 + kLine * line;
  let at = kName;
  const parts = data.lengths.map((length, part) => {
    const width = length * scale, from = at;
    at += width;
    return svg("rect", { x: from, y: top, width, height: kLine - 8, style: `fill:var(--series-${part % kColors})` },
      [svg("title", {}, [series[part]])]);
  });
  return [
    svg("text", { x: kName - 8, y: top + 16, "text-anchor": "end" }, [data.name]), ...parts,
    svg("text", { x: at + 8, y: top + 16 }, [data.value]),
  ];
}

/** Draws bars below each other, and a legend of their colors. */
function bars({ title, series, bars: list }) {
  const longest = Math.max(...list.map(({ lengths }) => lengths.reduce((sum, length) => sum + length, 0)), 1e-9);
  const height = kTop + 30 * list.length + 36, step = 110;
  return svg("svg", { viewBox: `0 0 ${kWidth} ${height}`, role: "img", "aria-label": title }, [
    ...series.flatMap((name, part) => [
      svg("rect", { x: 150 + step * part, y: 8, width: 14, height: 14, style: `fill:var(--series-${part % kColors})` }),
      svg("text", { x: 170 + step * part, y: 20 }, [name]),
    ]),
    ...list.flatMap((data, line) => bar(data, series, line, (kWidth - 230) / longest)),
    svg("text", { x: 150, y: height - 6, class: "soft" }, [title]),
  ]);
}

/** Rows of cells in a box that scrolls; `head`: the first row names the columns. */
function table(rows, head) {
  const cells = (row, name) => element("tr", {}, row.map((text) => element(name, {}, [text])));
  const lines = rows.map((row, number) => cells(row, head && number === 0 ? "th" : "td"));
  return element("div", { class: "scroll" }, [element("table", {}, lines)]);
}

function titled(title, ...children) {
  return [element("h2", {}, [title]), ...children];
}

function picture({ title, png }) {
  return element("figure", {}, [
    element("img", { alt: title, src: `data:image/png;base64,${png}` }),
    element("figcaption", {}, [title]),
  ]);
}

function draw(report) {
  document.title = report.title;
  const origin = report.origin.flatMap(([name, value]) => [
    element("dt", {}, [name]), element("dd", {}, [element("code", {}, [value])]),
  ]);
  document.body.append(element("h1", {}, [report.title]));
  if (report.verdict) document.body.append(element("p", { class: "verdict" }, [report.verdict]));
  document.body.append(element("dl", {}, origin));
  if (report.pictures.length > 0)
    document.body.append(element("div", { class: "pictures" }, report.pictures.map(picture)));
  if (report.figures.length > 0) document.body.append(...titled("Figures", table(report.figures, false)));
  for (const { title, about, rows, charts, bars: stacks } of report.tables) {
    document.body.append(...titled(title, ...charts.map(chart), ...stacks.map(bars), table(rows, true)));
    if (about) document.body.append(element("p", {}, [about]));
  }
  for (const note of report.notes) document.body.append(element("p", {}, [`Omitted: ${note}.`]));
}

draw(JSON.parse(document.getElementById("report").textContent));
