// SPDX-License-Identifier: GPL-3.0-or-later
// Curves over a common axis, by Chart.js.
'use strict';

/** The finite values that decide the vertical axis, of the series that are shown. */
function valueRange(plot) {
  let lower = Infinity, upper = -Infinity;
  const count = (value) => {
    if (!Number.isFinite(value) || (plot.log_y && value <= 0)) return;
    lower = Math.min(lower, value);
    upper = Math.max(upper, value);
  };
  for (const series of plot.series) {
    if (!isShown(series.pipeline)) continue;
    series.y.forEach(count);
    series.upper.forEach(count);
  }
  for (const threshold of plot.thresholds) count(threshold.value);
  if (plot.range.length > 0) [lower, upper] = plot.range;
  if (lower > upper) return plot.log_y ? [0.1, 10] : [0, 1];
  if (plot.log_y) {
    const margin = lower === upper ? 2 : (upper / lower) ** 0.05;
    return [lower / margin, upper * margin];
  }
  const margin = lower === upper ? Math.abs(lower) * 0.1 || 1 : 0.05 * (upper - lower);
  return [lower >= 0 && lower < 0.35 * upper ? 0 : lower - margin, upper + margin];
}

function axisRange(plot) {
  if (plot.x_names.length > 0) return [-0.5, plot.x_names.length - 0.5];
  let lower = Infinity, upper = -Infinity;
  for (const series of plot.series) {
    for (const x of series.x) {
      if (!Number.isFinite(x)) continue;
      lower = Math.min(lower, x);
      upper = Math.max(upper, x);
    }
  }
  if (lower > upper) return [0, 1];
  if (lower === upper) return [lower - 0.5, upper + 0.5];
  const single = plot.series.some((series) => series.kind === 'points');
  const margin = single ? 0.04 * (upper - lower) : 0;
  return [lower - margin, upper + margin];
}

/** What is infinite, or has no logarithm, is drawn beyond the edge, which cuts it off. */
function drawnValue(value, [lower, upper], log) {
  if (Number.isNaN(value)) return null;
  const below = log ? lower * 1e-3 : lower - 10 * (upper - lower);
  const above = log ? upper * 1e3 : upper + 10 * (upper - lower);
  return Math.min(Math.max(value, below), above);
}

function datasetsOf(series, range, log) {
  const colour = colourOf(series.pipeline, series.shade);
  const points = (values) => series.x.map((x, i) => ({ x, y: drawnValue(values[i], range, log) }));
  const common = {
    label: series.name, hidden: !isShown(series.pipeline), borderColor: colour, backgroundColor: colour, borderWidth: 1.8,
    borderDash: dashOf(series.pipeline, series.shade), pointRadius: series.x.length <= 12 ? 2.5 : 0, pointHoverRadius: 4, tension: 0, series,
  };
  if (series.kind === 'points') {
    return [{ ...common, data: points(series.y), showLine: false, pointRadius: 3.5, pointStyle: markerOf(series.pipeline, series.shade) }];
  }
  if (series.kind === 'steps') return [{ ...common, data: points(series.y), stepped: 'before' }];
  if (series.kind === 'line') return [{ ...common, data: points(series.y) }];
  const edge = { ...common, borderWidth: 1.2, borderColor: colourOf(series.pipeline, series.shade, 0.75) };
  return [
    { ...edge, data: points(series.y), fill: false },
    { ...edge, data: points(series.upper), fill: '-1', backgroundColor: colourOf(series.pipeline, series.shade, 0.14), upper: true },
  ];
}

/** Texts of vertical lines in at most three rows above the chart: two that would cover each other stand on both sides of their lines, or in two rows; one without room is left out. */
function placeMarks(marks, at, width, left, right) {
  const used = [-Infinity, -Infinity, -Infinity];
  const wide = (i) => width(marks[i].text) + 8;
  const fitsRightOf = (i) => at(marks[i].x) + 3 + wide(i) <= right;
  const isNear = (i, next) => {
    if (next >= marks.length) return false;
    const apart = at(marks[next].x) - at(marks[i].x);
    return apart > 0.5 && apart < (wide(i) + wide(next)) / 2;
  };
  const rowFrom = (place) => {
    const row = used.findIndex((end) => end <= place);
    return row < 0 ? null : row;
  };
  let leftRow = null;  // of the text before, where it stands left of its line
  const place = (i) => {
    const line = at(marks[i].x), before = leftRow, half = wide(i) / 2;
    leftRow = null;
    if (before !== null && fitsRightOf(i)) return { row: before, centre: line + 3 + half };
    if (isNear(i, i + 1) && line - 3 - 2 * half >= left && fitsRightOf(i + 1)) leftRow = rowFrom(line - 3 - 2 * half);
    if (leftRow !== null) return { row: leftRow, centre: line - 3 - half };
    const centre = Math.min(Math.max(line, left + half), Math.max(left + half, right - half));
    return { row: rowFrom(centre - half), centre };
  };
  return marks.map((mark, i) => {
    const { row, centre } = place(i);
    if (row !== null) used[row] = centre + wide(i) / 2;
    return { mark, row, centre };
  });
}

/** Small marks: triangles at the lower edge, those of every pipeline above those of the one before. */
function drawTriangles(ctx, marks, x, bottom) {
  const pipelines = [...new Set(marks.map((mark) => mark.pipeline))];
  for (const mark of marks) {
    const y = bottom - 8 * pipelines.indexOf(mark.pipeline), at = x(mark.x);
    ctx.fillStyle = colourOf(mark.pipeline);
    ctx.beginPath();
    ctx.moveTo(at - 4, y);
    ctx.lineTo(at + 4, y);
    ctx.lineTo(at, y - 8);
    ctx.fill();
  }
}

/** A text that curves and lines do not cross. */
function haloText(ctx, text, x, y) {
  ctx.save();
  ctx.setLineDash([]);
  ctx.lineWidth = 3;
  ctx.lineJoin = 'round';
  ctx.strokeStyle = variable('--card');
  ctx.strokeText(text, x, y);
  ctx.restore();
  ctx.fillText(text, x, y);
}

/** Thresholds and marks, over the curves. */
const linesPlugin = {
  id: 'lines',
  afterDatasetsDraw(chart) {
    const { ctx, chartArea: area, scales } = chart;
    const plot = chart.options.plugins.lines.plot;
    ctx.save();
    ctx.font = `11px ${Chart.defaults.font.family}`;
    ctx.lineWidth = 1;
    for (const { name, value } of plot.thresholds) {
      const y = scales.y.getPixelForValue(value);
      ctx.strokeStyle = ctx.fillStyle = variable('--ink');
      ctx.setLineDash([6, 4]);
      ctx.beginPath();
      ctx.moveTo(area.left, y);
      ctx.lineTo(area.right, y);
      ctx.stroke();
      ctx.textAlign = 'right';
      haloText(ctx, name, area.right - 4, y < area.top + 16 ? y + 12 : y - 4);
    }
    ctx.setLineDash([3, 3]);
    const at = (x) => scales.x.getPixelForValue(x);
    const isInside = (mark) => isShown(mark.pipeline) && at(mark.x) >= area.left - 1 && at(mark.x) <= area.right + 1;
    const marks = plot.marks.filter(isInside).sort((a, b) => a.x - b.x);
    drawTriangles(ctx, marks.filter((mark) => mark.small), at, area.bottom);
    const placed = placeMarks(marks.filter((mark) => !mark.small), at, (text) => ctx.measureText(text).width, 0, chart.width);
    for (const { mark, row } of placed) {
      ctx.strokeStyle = colourOf(mark.pipeline, 0, 0.7);
      ctx.beginPath();
      ctx.moveTo(at(mark.x), row === null ? area.top : area.top - 6 - 13 * row);
      ctx.lineTo(at(mark.x), area.bottom);
      ctx.stroke();
    }
    ctx.textAlign = 'center';
    for (const { mark, row, centre } of placed) {
      if (row === null) continue;
      ctx.fillStyle = mark.pipeline === ofData ? variable('--soft') : colourOf(mark.pipeline);
      haloText(ctx, mark.text, centre, area.top - 8 - 13 * row);
    }
    ctx.restore();
  },
};

function tooltipText(item) {
  const { series } = item.dataset;
  if (item.dataset.upper || series.name === '') return null;
  const i = item.dataIndex;
  const digits = digitsWithin(item.chart.scales.y.min, item.chart.scales.y.max);
  const value = series.kind === 'band' ? `[${short(series.y[i], digits)}, ${short(series.upper[i], digits)}]` : short(series.y[i], digits);
  return `${series.name}: ${value}`;
}

function plotScales(plot) {
  const ink = variable('--soft'), grid = { color: variable('--line'), borderColor: variable('--strong-line') };
  const title = (text) => ({ display: text !== '', text, color: ink, font: { size: 12 } });
  const ticks = { color: ink, font: { size: 11 }, autoSkip: true, maxRotation: plot.x_names.length > 0 ? 40 : 0 };
  const [left, right] = axisRange(plot);
  const [lower, upper] = valueRange(plot);
  const whole = plot.series.every((series) => series.x.every(Number.isInteger));
  const setTicks = (make) => (axis) => { axis.ticks = make(axis).map((value) => ({ value })); };
  return {
    x: {
      type: 'linear', min: left, max: right, grid, title: title(plot.x_label),
      ticks: { ...ticks, callback: (value) => (plot.x_names.length > 0 ? plot.x_names[value] ?? '' : short(value, digitsWithin(left, right))) },
      afterBuildTicks: setTicks((axis) => (plot.x_names.length > 0 ? plot.x_names.map((_, i) => i) : niceTicks(left, right, axis.width > 500 ? 9 : 5, whole))),
    },
    y: {
      type: plot.log_y ? 'logarithmic' : 'linear', min: lower, max: upper, grid, title: title(plot.y_label),
      ticks: { ...ticks, autoSkip: false, callback: (value) => (plot.log_y ? logText(value, hasPowers(lower, upper)) : short(value, digitsWithin(lower, upper))) },
      afterBuildTicks: setTicks(() => (plot.log_y ? logTicks(lower, upper) : uprightTicks(lower, upper, 6))),
    },
  };
}

function plotOptions(plot) {
  return {
    animation: false, responsive: true, maintainAspectRatio: false, parsing: false, spanGaps: false, resizeDelay: 60,
    layout: { padding: { top: plot.marks.some((mark) => !mark.small) ? 46 : 6, right: 10 } },
    interaction: { mode: 'nearest', axis: 'x', intersect: false },
    plugins: {
      legend: { display: false }, filler: { propagate: false }, lines: { plot },
      tooltip: {
        filter: (item) => !item.dataset.upper,
        callbacks: {
          title: (items) => (items.length === 0 ? '' : plot.x_names[items[0].parsed.x] ?? `${plot.x_label} = ${short(items[0].parsed.x, 12)}`),
          label: tooltipText,
        },
      },
    },
    scales: plotScales(plot),
  };
}

/** The plot with its numbers as arrays; made when they are first needed. */
function unpacked(plot) {
  if (!plot.isUnpacked) {
    for (const series of plot.series) {
      for (const member of ['x', 'y', 'upper']) series[member] = numbersOf(series[member]);
    }
    plot.isUnpacked = true;
  }
  return plot;
}

function plotNumbers(plot) {
  const header = [plot.x_label || 'x'];
  const rows = new Map();
  const column = (name, xs, values) => {
    const place = header.push(name) - 1;
    xs.forEach((x, i) => {
      if (!rows.has(x)) rows.set(x, []);
      rows.get(x)[place] = values[i];
    });
  };
  for (const series of plot.series.filter((one) => isShown(one.pipeline))) {
    const called = series.name || data.pipelines[series.pipeline] || '';
    column(series.kind === 'band' ? `${called}, lower` : called, series.x, series.y);
    if (series.kind === 'band') column(`${called}, upper`, series.x, series.upper);
  }
  const name = (x) => plot.x_names[x] ?? x;
  const sorted = [...rows].sort(([a], [b]) => a - b);
  return { header, rows: sorted.map(([x, values]) => header.map((_, i) => (i === 0 ? name(x) : values[i] ?? NaN))) };
}

function plotView(figure) {
  const plot = figure.plot;
  const canvas = element('canvas', { role: 'img' });
  const legend = element('ul', { class: 'legend', 'aria-label': 'Curves' });
  const numbers = numbersPart(figure, () => plotNumbers(unpacked(plot)));
  let chart = null;

  const label = () => {
    const [left, right] = axisRange(plot), [lower, upper] = valueRange(plot);
    const names = plot.series.filter((series) => isShown(series.pipeline) && series.name !== '').map((series) => series.name);
    const across = plot.x_names.length > 0 ? plot.x_names.join(', ') : `${short(left)} to ${short(right)}`;
    canvas.setAttribute('aria-label', `${figure.title}. ${names.length} curves: ${names.join(', ')}. ${plot.x_label}: ${across}. ` +
      `${plot.y_label}: ${short(lower, 3)} to ${short(upper, 3)}${plot.log_y ? ', logarithmic' : ''}.`);
  };
  const update = () => {
    const small = plot.marks.filter((mark) => mark.small);
    const texts = [...new Set(small.map((mark) => mark.text))];
    const ownerOf = (text) => {
      const owners = new Set(small.filter((mark) => mark.text === text).map((mark) => mark.pipeline));
      return owners.size === 1 ? [...owners][0] : ofData;
    };
    legend.replaceChildren(...plot.series.filter((series) => series.name !== '').map((series) => element('li', { class: isShown(series.pipeline) ? undefined : 'off' },
      swatch(series.pipeline, series.shade, series.kind), series.name)), ...texts.map((text) => element('li', {}, swatch(ownerOf(text), 0, 'triangle'), text)));
    legend.hidden = texts.length === 0 && plot.series.length < 2 && plot.series.every((series) => series.name === '');
    numbers.refresh();
    if (chart === null) return;
    label();
    const range = valueRange(plot);
    chart.data.datasets = plot.series.flatMap((series) => datasetsOf(series, range, plot.log_y));
    chart.options = plotOptions(plot);
    chart.update('none');
  };
  const create = () => {
    if (chart !== null) return;
    const range = valueRange(unpacked(plot));
    chart = new Chart(canvas, {
      type: 'line', data: { datasets: plot.series.flatMap((series) => datasetsOf(series, range, plot.log_y)) },
      options: plotOptions(plot), plugins: [linesPlugin],
    });
    label();
  };
  return { parts: [element('div', { class: 'canvas' }, canvas), legend, numbers.details], create, update, resize: () => chart?.resize() };
}
