// SPDX-License-Identifier: GPL-3.0-or-later
// Projections of sets to two coordinates, one time after another.
'use strict';

const stageWidth = 640, stageHeight = 430;
const stageMargin = { right: 14, top: 12, bottom: 46 };

/** Axes of a frame, and the maps from its coordinates to those of the drawing. */
function stageAxes(projection, frame) {
  const right = stageWidth - stageMargin.right, bottom = stageHeight - stageMargin.bottom;
  const across = (value) => short(value, digitsWithin(frame.left, frame.right));
  const upwards = (value) => short(value, digitsWithin(frame.bottom, frame.top));
  const xLabel = 7 * Math.max(across(frame.left).length, across(frame.right).length);
  const yTicks = uprightTicks(frame.bottom, frame.top, 6);
  const left = 22 + 7 * Math.max(5, ...yTicks.map((tick) => upwards(tick).length));
  const x = (value) => left + ((value - frame.left) / (frame.right - frame.left)) * (right - left);
  const y = (value) => bottom - ((value - frame.bottom) / (frame.top - frame.bottom)) * (bottom - stageMargin.top);
  const parts = [];
  for (const tick of niceTicks(frame.left, frame.right, Math.min(7, Math.floor((right - left) / (xLabel + 14))))) {
    parts.push(drawn('line', { class: 'grid', x1: x(tick), x2: x(tick), y1: stageMargin.top, y2: bottom }),
      drawn('text', { x: x(tick), y: bottom + 18, 'text-anchor': 'middle' }, across(tick)));
  }
  for (const tick of yTicks) {
    parts.push(drawn('line', { class: 'grid', x1: left, x2: right, y1: y(tick), y2: y(tick) }),
      drawn('text', { x: left - 8, y: y(tick) + 4, 'text-anchor': 'end' }, upwards(tick)));
  }
  parts.push(drawn('rect', { class: 'frame', x: left, y: stageMargin.top, width: right - left, height: bottom - stageMargin.top }),
    drawn('text', { x: (left + right) / 2, y: stageHeight - 8, 'text-anchor': 'middle' }, projection.x_label),
    drawn('text', { x: 14, y: (stageMargin.top + bottom) / 2, 'text-anchor': 'middle', transform: `rotate(-90 14 ${(stageMargin.top + bottom) / 2})` }, projection.y_label));
  return { x, y, parts };
}

/** A polygon: its area, its edges, and those edges dashed beyond which the set goes on. */
function stageSet(set, { x, y }) {
  const at = set.x.map((_, i) => [x(set.x[i]), y(set.y[i])]);
  const colour = colourOf(set.pipeline);
  const group = drawn('g', { 'data-pipeline': set.pipeline });
  if (at.length === 1) group.append(drawn('circle', { cx: at[0][0], cy: at[0][1], r: 4, fill: colour }));
  if (at.length > 2) group.append(drawn('polygon', { points: at.map((point) => point.join(',')).join(' '), fill: colour, 'fill-opacity': 0.13 }));
  for (let i = 0; i < at.length && at.length > 1; ++i) {
    if (at.length === 2 && i === 1) break;
    const [from, to] = [at[i], at[(i + 1) % at.length]];
    const dash = set.open[i] ? '2 5' : dashOf(set.pipeline).join(' ') || undefined;
    group.append(drawn('line', {
      x1: from[0], y1: from[1], x2: to[0], y2: to[1], stroke: colour, 'stroke-width': set.open[i] ? 3 : 2, 'stroke-dasharray': dash,
      'stroke-linecap': 'round', class: set.open[i] ? 'open' : undefined,
    }));
  }
  return group;
}

/** In words what a drawing cannot show. */
function stageWords(frame) {
  const name = (set) => data.pipelines[set.pipeline];
  const sets = frame.sets.filter((set) => isShown(set.pipeline));
  const empty = sets.filter((set) => set.x.length === 0).map(name);
  const open = sets.filter((set) => set.open.some(Boolean)).map(name);
  const words = [];
  if (empty.length > 0) words.push(`Proven empty: ${empty.join(', ')}.`);
  if (open.length > 0) words.push(`Dotted edges: the set continues beyond the frame (${open.join(', ')}).`);
  const missing = data.pipelines.filter((_, i) => shown[i] && !frame.sets.some((set) => set.pipeline === i));
  if (missing.length > 0) words.push(`No set at this time: ${missing.join(', ')}.`);
  if (frame.truth) words.push(`True state: (${short(frame.truth[0], digitsWithin(frame.left, frame.right))}, ${short(frame.truth[1], digitsWithin(frame.bottom, frame.top))}).`);
  return words.join(' ');
}

function projectionNumbers(projection, frames) {
  const rows = frames.flatMap((frame) => frame.sets.filter((set) => isShown(set.pipeline)).flatMap((set) =>
    set.x.map((_, i) => [frame.k, data.pipelines[set.pipeline], i + 1, set.x[i], set.y[i], set.open[i] ? 'open' : ''])));
  const truth = frames.filter((frame) => frame.truth).map((frame) => [frame.k, 'true state', 1, ...frame.truth, '']);
  return { header: ['k', 'set', 'vertex', projection.x_label, projection.y_label, 'edge to the next'], rows: [...rows, ...truth] };
}

function projectionView(figure) {
  const { frames } = figure.projection;
  const last = Math.max(0, frames.length - 1);
  // Opens where there is something to see: sets that are proven empty at the end have no picture.
  const seen = frames.findLastIndex((frame) => frame.sets.some((set) => set.x.length > 0));
  let at = seen < 0 ? last : seen;
  const svg = drawn('svg', { viewBox: `0 0 ${stageWidth} ${stageHeight}`, role: 'img' });
  const told = element('p', { class: 'told', 'aria-live': 'polite' });
  const slider = element('input', { type: 'range', min: 0, max: last, step: 1, value: at, 'aria-label': `Time k of ${figure.title}` });
  const output = element('output');
  const numbers = numbersPart(figure, () => projectionNumbers(figure.projection, frames), () => projectionNumbers(figure.projection, [frames[at]]));
  let created = false;

  const draw = () => {
    const frame = frames[at];
    if (!created || frame === undefined) return;
    const axes = stageAxes(figure.projection, frame);
    const clip = `clip_${figure.id}`;
    const sets = drawn('g', { 'clip-path': `url(#${clip})` }, ...frame.sets.filter((set) => isShown(set.pipeline)).map((set) => stageSet(set, axes)));
    const frameBox = axes.parts.find((part) => part.getAttribute('class') === 'frame').cloneNode();
    frameBox.removeAttribute('class');
    svg.replaceChildren(drawn('defs', {}, drawn('clipPath', { id: clip }, frameBox)), ...axes.parts, sets);
    if (frame.truth) svg.append(drawn('circle', { class: 'truth', cx: axes.x(frame.truth[0]), cy: axes.y(frame.truth[1]), r: 5 }));
    const time = frame.time ?? `k = ${frame.k}`;
    output.textContent = time;
    slider.setAttribute('aria-valuetext', time);
    told.textContent = stageWords(frame);
    svg.setAttribute('aria-label', `${figure.title} at ${time}. ${told.textContent}`);
    numbers.refresh();
  };
  slider.addEventListener('input', () => { at = Number(slider.value); draw(); });
  const create = () => { if (!created) { created = true; draw(); } };
  const parts = [element('div', { class: 'stage' }, svg), told, numbers.details];
  if (frames.length > 1) parts.splice(1, 0, element('div', { class: 'slider' }, element('span', { class: 'told' }, 'Time'), slider, output));
  return { parts, create, update: draw, resize: () => {} };
}
