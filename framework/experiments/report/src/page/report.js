// SPDX-License-Identifier: GPL-3.0-or-later
// The page: its head, switches, sections, and the figures in them.
'use strict';

/* Tables. */
function sortValue(text) {
  const value = parseFloat(text.replaceAll('−', '-').replaceAll(/[ ,  ](?=\d{3})/g, ''));
  return Number.isNaN(value) ? null : value;
}
function sortRows(body, column, descending) {
  const rows = [...body.rows].map((row) => ({ row, text: row.cells[column].textContent, value: sortValue(row.cells[column].textContent) }));
  const byText = (a, b) => a.text.localeCompare(b.text);
  rows.sort((a, b) => (a.value === null || b.value === null ? (a.value === b.value ? byText(a, b) : a.value === null ? 1 : -1) : a.value - b.value));
  if (descending) rows.reverse();
  body.append(...rows.map(({ row }) => row));
}
/** The pipeline that a row of a table is about: the one whose name is one of its cells. */
const rowPipeline = (row) => row.map((one) => (one.number ? -1 : data.pipelines.indexOf(one.text))).find((index) => index >= 0) ?? ofData;

function tableView(figure) {
  const { header, rows } = figure.table;
  const isNumber = header.map((_, i) => rows.some((row) => row[i]?.number));
  const cellOf = (one) => {
    const classes = [one.number && 'number', one.best && 'best', one.text.length > 40 && 'prose'];
    const td = element('td', { class: classes.filter(Boolean).join(' ') || undefined }, one.text);
    if (one.share > 0) td.style.backgroundColor = `rgba(var(--best), ${(0.06 + 0.3 * one.share).toFixed(3)})`;
    return td;
  };
  const body = element('tbody', {}, ...rows.map((row) => {
    const pipeline = rowPipeline(row);
    return element('tr', { 'data-pipeline': pipeline === ofData ? undefined : pipeline }, ...row.map(cellOf));
  }));
  const heads = header.map((name, i) => {
    const button = element('button', { type: 'button', title: 'Sort by this column' }, name);
    const th = element('th', { scope: 'col', class: isNumber[i] ? 'number' : undefined }, button);
    button.addEventListener('click', () => {
      const descending = th.getAttribute('aria-sort') === 'ascending';
      heads.forEach((other) => other.removeAttribute('aria-sort'));
      th.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
      sortRows(body, i, descending);
    });
    return th;
  });
  const table = element('table', { class: header.length > 8 ? 'dense' : undefined }, element('thead', {}, element('tr', {}, ...heads)), body);
  const update = () => [...body.rows].forEach((row) => { row.hidden = 'pipeline' in row.dataset && !isShown(Number(row.dataset.pipeline)); });
  return { parts: [element('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': figure.title }, table)], create() {}, update, resize() {} };
}

/* Drawings that are ready: timelines and intervals. */
function drawingView(figure) {
  const plate = element('div', { class: 'plate', tabindex: 0, role: 'region', 'aria-label': figure.title });
  plate.append(document.getElementById(`drawing_${figure.id}`).content.cloneNode(true));
  const numbers = numbersPart(figure, () => figure.numbers);
  const update = () => plate.querySelectorAll('[data-pipeline]').forEach((part) => {
    part.setAttribute('visibility', isShown(Number(part.dataset.pipeline)) ? 'visible' : 'hidden');
  });
  return { parts: [plate, numbers.details], create() {}, update, resize() {} };
}

const viewMakers = { plot: plotView, projection: projectionView, table: tableView, timeline: drawingView, intervals: drawingView };
const views = [];

function card(figure) {
  const view = viewMakers[figure.kind](figure);
  const wide = figure.kind !== 'plot' && figure.kind !== 'projection';
  const long = figure.kind === 'table' && figure.table.rows.length > 25;
  const heading = element('h3', { id: `title_${figure.id}` }, figure.title);
  const owner = element('span', { class: 'owner' });
  const article = element('article', { class: `card${wide ? ' wide' : ''}${long ? ' long' : ''}`, id: `figure_${figure.id}`, 'aria-labelledby': heading.id },
    element('header', {}, heading, owner));
  if (figure.caption !== '') article.append(element('p', { class: 'caption' }, figure.caption));
  article.append(...view.parts);
  const update = () => {
    article.hidden = !isShown(figure.pipeline);
    owner.replaceChildren(...(figure.pipeline === ofData ? [] : [swatch(figure.pipeline), data.pipelines[figure.pipeline]]));
    view.update();
  };
  views.push({ ...view, update, article });
  return article;
}

/** Cards stand in pairs; the last of an odd number of neighbours takes the whole width, so that no place stays empty. */
function fillRows(cards) {
  let alone = null;
  for (const one of [...cards, null]) {
    const wide = one === null || one.classList.contains('wide');
    if (wide) {
      alone?.classList.add('wide');
      alone = null;
    } else {
      alone = alone === null ? one : null;
    }
  }
  return cards;
}

function buildSections() {
  const content = document.getElementById('content'), contents = document.getElementById('contents');
  const names = [...new Set(data.figures.map((figure) => figure.section))];
  names.forEach((name, i) => {
    const id = `section_${i + 1}`;
    const figures = data.figures.filter((figure) => figure.section === name);
    content.append(element('section', { id, 'aria-labelledby': `${id}_title` }, element('h2', { id: `${id}_title` }, name),
      element('div', { class: 'figures' }, ...fillRows(figures.map(card)))));
    contents.append(element('a', { href: `#${id}` }, name));
  });
  contents.hidden = names.length < 2;
}

function buildHead() {
  const count = data.pipelines.length;
  const versions = data.versions.slice(0, 1).map(([name, value]) => `${name} ${value}`);
  document.getElementById('facts').textContent = [`${count} ${count === 1 ? 'pipeline' : 'pipelines'}`, `${data.figures.length} figures`, ...versions].join(' · ');
  document.getElementById('notes').append(...data.notes.map((text) => element('p', { class: 'note', role: 'note' }, text)));
  document.getElementById('versions').append(...data.versions.flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)]));
  const study = document.getElementById('study');
  study.hidden = data.study === '';
  study.querySelector('pre').textContent = data.study;
}

const updateAll = () => views.forEach((view) => view.update());

function buildSwitches() {
  const place = document.getElementById('switches');
  const chips = data.pipelines.map((name, i) => {
    const chip = element('button', { type: 'button', class: 'chip', title: name, 'data-pipeline': i });
    chip.addEventListener('click', () => { shown[i] = !shown[i]; refresh(); updateAll(); });
    return chip;
  });
  const refresh = () => chips.forEach((chip, i) => {
    chip.setAttribute('aria-pressed', String(shown[i]));
    chip.replaceChildren(swatch(i), element('span', {}, data.pipelines[i]));
  });
  place.append(...chips);
  if (data.pipelines.length > 3) {
    for (const [text, state] of [['All', true], ['None', false]]) {
      const button = element('button', { type: 'button', class: 'plain' }, text);
      button.addEventListener('click', () => { shown.fill(state); refresh(); updateAll(); });
      place.append(button);
    }
  }
  return refresh;
}

/* Light and dark. Paper is always light. */
function buildTheme(refreshSwitches) {
  const root = document.documentElement, button = document.getElementById('theme');
  const system = matchMedia('(prefers-color-scheme: dark)');
  let chosen = null;
  const set = (dark) => {
    root.dataset.theme = dark ? 'dark' : 'light';
    button.setAttribute('aria-pressed', String(dark));
    Chart.defaults.color = variable('--soft');
    refreshSwitches();
    updateAll();
  };
  const current = () => chosen ?? system.matches;
  button.addEventListener('click', () => { chosen = !current(); set(chosen); });
  system.addEventListener('change', () => { if (chosen === null) set(system.matches); });
  addEventListener('beforeprint', () => { views.forEach((view) => view.create()); set(false); views.forEach((view) => view.resize()); });
  addEventListener('afterprint', () => { set(current()); views.forEach((view) => view.resize()); });
  document.getElementById('print').addEventListener('click', () => window.print());
  root.dataset.theme = current() ? 'dark' : 'light';
  return () => set(current());
}

/** Figures are drawn when they come near the window, so that a long report opens at once. */
function drawWhenSeen() {
  const observer = new IntersectionObserver((entries) => {
    for (const entry of entries.filter((one) => one.isIntersecting)) {
      views.find((view) => view.article === entry.target).create();
      observer.unobserve(entry.target);
    }
  }, { rootMargin: '200px' });
  views.forEach((view) => observer.observe(view.article));
}

Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
buildHead();
const refreshSwitches = buildSwitches();
const applyTheme = buildTheme(refreshSwitches);
buildSections();
applyTheme();
drawWhenSeen();
