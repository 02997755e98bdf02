// SPDX-License-Identifier: GPL-3.0-or-later
// What the figures share: elements, colours, ticks and numbers as text. All text of a report goes through text nodes and attributes.
'use strict';

const data = JSON.parse(document.getElementById('report-data').textContent);
const ofData = -1;
/** Which pipelines are shown. */
const shown = data.pipelines.map(() => true);
const isShown = (pipeline) => pipeline === ofData || shown[pipeline];

const svgSpace = 'http://www.w3.org/2000/svg';
function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== undefined && value !== false) node.setAttribute(name, value === true ? '' : String(value));
  }
  node.append(...children);
  return node;
}
const element = (name, attributes = {}, ...children) => fill(document.createElement(name), attributes, children);
const drawn = (name, attributes = {}, ...children) => fill(document.createElementNS(svgSpace, name), attributes, children);

/* Colours: one per pipeline; where pipelines outnumber colours, dashes and markers tell them apart. */
const theme = () => document.documentElement.dataset.theme;
const variable = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const palette = () => data.palette[theme()];
const dashes = [[], [7, 4], [2, 3], [9, 3, 2, 3], [14, 4]];
const markers = ['circle', 'rect', 'triangle', 'rectRot', 'star'];

/** Whose turn it is among lines of one colour: 0 is solid. */
const turn = (pipeline, shade) => shade + (pipeline === ofData ? 0 : Math.floor(pipeline / palette().length));
const dashOf = (pipeline, shade = 0) => dashes[turn(pipeline, shade) % dashes.length];
const markerOf = (pipeline, shade = 0) => markers[turn(pipeline, shade) % markers.length];

const channels = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
/** A colour of pipeline and shade: later shades lie nearer to the paper. */
function colourOf(pipeline, shade = 0, alpha = 1) {
  const base = channels(pipeline === ofData ? variable('--ink') : palette()[pipeline % palette().length]);
  const paper = channels(variable('--card'));
  const share = Math.min(0.6, 0.22 * shade);
  const mixed = base.map((value, i) => Math.round(value + (paper[i] - value) * share));
  return `rgba(${mixed.join(', ')}, ${alpha})`;
}

/** A short line as a pipeline draws it. */
function swatch(pipeline, shade = 0, kind = 'line') {
  const svg = drawn('svg', { width: 26, height: 12, viewBox: '0 0 26 12', 'aria-hidden': 'true' });
  const stroke = colourOf(pipeline, shade);
  if (kind === 'band') {
    svg.append(drawn('rect', { x: 1, y: 2, width: 24, height: 8, fill: stroke, 'fill-opacity': 0.3, stroke, 'stroke-opacity': 0.6 }));
  } else if (kind === 'triangle') {
    svg.append(drawn('polygon', { points: '8,11 18,11 13,2', fill: stroke }));
  } else if (kind === 'points') {
    const square = markerOf(pipeline, shade) === 'rect';
    svg.append(square ? drawn('rect', { x: 9.5, y: 2.5, width: 7, height: 7, fill: stroke }) : drawn('circle', { cx: 13, cy: 6, r: 4, fill: stroke }));
  } else {
    svg.append(drawn('line', { x1: 1, x2: 25, y1: 6, y2: 6, stroke, 'stroke-width': 3, 'stroke-dasharray': dashOf(pipeline, shade).join(' ') || undefined }));
  }
  return svg;
}

/* Axes. */
/** Round numbers within [lower, upper], about `count` of them. */
function niceTicks(lower, upper, count = 6, whole = false) {
  const rough = (upper - lower) / Math.max(1, count);
  if (!(rough > 0) || !Number.isFinite(rough)) return [lower];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = Math.max(whole ? 1 : 0, power * ([1, 2, 5].find((m) => m * power >= rough * (1 - 1e-9)) ?? 10));
  const ticks = [];
  const first = Math.ceil(lower / step - 1e-9), last = Math.floor(upper / step + 1e-9);
  for (let i = 0; first + i <= last && i < 100; ++i) {  // far from the origin, ticks may not be told apart
    const tick = Number(((first + i) * step).toPrecision(14));
    if (tick !== ticks.at(-1)) ticks.push(tick);
  }
  return ticks;
}
/** The same, closer where there would be fewer than three although there is room for as many. */
function uprightTicks(lower, upper, count = 6) {
  const ticks = niceTicks(lower, upper, count);
  return ticks.length < 3 && count >= 3 ? niceTicks(lower, upper, 2 * count) : ticks;
}
/** Powers of ten within [lower, upper]; with 2 and 5 between them where they are few; round numbers where these are fewer than three. */
function logTicks(lower, upper) {
  const first = Math.floor(Math.log10(lower) + 1e-9), last = Math.ceil(Math.log10(upper) - 1e-9);
  const every = Math.max(1, Math.ceil((last - first) / 8));
  const ticks = [];
  for (let power = first; power <= last; power += every) {
    for (const factor of last - first <= 3 ? [1, 2, 5] : [1]) ticks.push(Number((factor * 10 ** power).toPrecision(12)));
  }
  const within = ticks.filter((tick) => tick >= lower * (1 - 1e-9) && tick <= upper * (1 + 1e-9));
  return within.length < 3 ? uprightTicks(lower, upper, 4) : within;
}

const superscripts = { '-': '⁻', 0: '⁰', 1: '¹', 2: '²', 3: '³', 4: '⁴', 5: '⁵', 6: '⁶', 7: '⁷', 8: '⁸', 9: '⁹' };
/** A number as a reader likes it: few digits, powers of ten where it is very large or small. */
function short(value, digits = 6) {
  if (value === null || Number.isNaN(value)) return '–';
  if (!Number.isFinite(value)) return value > 0 ? '∞' : '−∞';
  const rounded = Number(value.toPrecision(digits));
  const size = Math.abs(rounded);
  if (size !== 0 && (size >= 1e6 || size < 1e-4)) {
    const [mantissa, power] = rounded.toExponential().split('e');
    const exponent = [...String(Number(power))].map((c) => superscripts[c]).join('');
    const factor = Math.abs(mantissa) === 1 ? mantissa.slice(0, -1) : `${mantissa}·`;
    return `${factor.replace('-', '−')}10${exponent}`;
  }
  return String(rounded).replace('-', '−');
}

/** The digits, from 6 to 15, that tell values of [lower, upper] apart, also far from the origin. */
function digitsWithin(lower, upper) {
  const size = Math.max(Math.abs(lower), Math.abs(upper)) / (upper - lower);
  return Number.isFinite(size) && size > 0 ? Math.min(15, Math.max(6, Math.ceil(Math.log10(size)) + 4)) : 6;
}

/** Are numbers of a logarithmic axis written with powers of ten? So they are, all of them, if a tick lies outside of [0.001, 10000]. */
function hasPowers(lower, upper) {
  const ticks = logTicks(lower, upper);
  return ticks[0] < 1e-3 || ticks.at(-1) > 1e4;
}
/** A number on a logarithmic axis: "0.002", or "2·10⁻³" with powers of ten, also where it is 1. */
function logText(value, powers) {
  if (!powers) return short(value);
  const power = Math.floor(Math.log10(value) + 1e-9);
  const factor = short(value / 10 ** power), ten = `10${[...String(power)].map((c) => superscripts[c]).join('')}`;
  return factor === '1' ? ten : `${factor}·${ten}`;
}

/** The numbers of the page's data: infinite ones are words there, gaps are null. */
function number(value) {
  if (value === 'inf') return Infinity;
  if (value === '-inf') return -Infinity;
  return value === null ? NaN : value;
}
const numbersOf = (packed) => (Array.isArray(packed) ? packed.map(number) : Array.from({ length: packed.count }, (_, i) => packed.from + i * packed.by));

/* The numbers of a figure: a table made when it is opened, and a CSV file. */
const cell = (value) => (typeof value === 'number' ? (Number.isNaN(value) ? '' : String(value)) : value);
function csvOf({ header, rows }) {
  const quoted = (text) => (/[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  return [header, ...rows].map((row) => row.map((value) => quoted(cell(value))).join(',')).join('\n') + '\n';
}

const mostRows = 1000;
function tableOf({ header, rows }) {
  const numeric = (value) => typeof value === 'number';
  const columns = header.map((_, i) => rows.length > 0 && rows.every((row) => numeric(row[i])));
  const side = (i) => (columns[i] ? 'number' : undefined);
  return element('table', {},
    element('thead', {}, element('tr', {}, ...header.map((name, i) => element('th', { scope: 'col', class: side(i) }, name)))),
    element('tbody', {}, ...rows.slice(0, mostRows).map((row) => element('tr', {},
      ...row.map((value, i) => element('td', { class: side(i) }, numeric(value) ? short(value) : cell(value)))))));
}

/** `numbers()` gives {header, rows}; `now()` the rows to show at this moment, if they are fewer. */
function numbersPart(figure, numbers, now = numbers) {
  const place = element('div');
  const details = element('details', { class: 'numbers' }, element('summary', {}, 'Numbers'), place);
  const refresh = () => {
    if (!details.open) return;
    const content = now();
    const link = element('button', { type: 'button', class: 'plain' }, 'Download as CSV');
    link.addEventListener('click', () => {
      const url = URL.createObjectURL(new Blob([csvOf(numbers())], { type: 'text/csv' }));
      element('a', { href: url, download: `${figure.id}.csv` }).click();
      setTimeout(() => URL.revokeObjectURL(url), 1000);
    });
    const hidden = content.rows.length > mostRows ? ` The first ${mostRows} of ${content.rows.length} rows are shown.` : '';
    place.replaceChildren(
      element('p', {}, 'Rounded for this page.', hidden, ' ', link),
      element('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': `Numbers of ${figure.title}` }, tableOf(content)));
  };
  details.addEventListener('toggle', refresh);
  return { details, refresh };
}
