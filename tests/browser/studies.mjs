// SPDX-License-Identifier: GPL-3.0-or-later
// Reports of real runs: browser_test studies.mjs CORDON SOURCES SCRATCH
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { close, dataOf, launch, open, openNumbers, show } from './browser.mjs';

const [cordon, sources, scratch] = process.env.CORDON_TEST_ARGUMENTS.split('\n');
const examples = join(sources, 'examples', 'studies');
let browser;

before(async () => {
  rmSync(scratch, { recursive: true, force: true });
  mkdirSync(scratch, { recursive: true });
  browser = await launch();
});
after(() => browser.close());

function run(study, directory) {
  try {
    execFileSync(cordon, ['run', study, '--out', directory, '--quiet'], { stdio: ['ignore', 'ignore', 'pipe'] });
  } catch (error) {
    // A model contradicts itself, a guarantee was violated, a solver gave no answer in its limit: the results are there all the same.
    if (![2, 4, 5].includes(error.status) || !existsSync(join(directory, 'report.html'))) throw new Error(`cordon run ${study}: ${error.stderr}`);
  }
  return JSON.parse(readFileSync(join(directory, 'results.json'), 'utf8'));
}

/** All that switches can change, as text. */
const state = (page) => page.evaluate(() => JSON.stringify([
  [...document.querySelectorAll('article')].map((one) => one.hidden),
  [...document.querySelectorAll('canvas')].map((canvas) => Chart.getChart(canvas)?.data.datasets.map((_, i) => Chart.getChart(canvas).isDatasetVisible(i))),
  [...document.querySelectorAll('.stage svg')].map((svg) => svg.innerHTML),
  [...document.querySelectorAll('tbody tr')].map((row) => row.hidden),
  [...document.querySelectorAll('.plate [data-pipeline]')].map((part) => part.getAttribute('visibility')),
]));

async function trySwitches(page, data) {
  const before = await state(page);
  for (const chip of await page.locator('.chip').all()) {
    await chip.click();
    const without = await state(page);
    if (data.figures.length > 0) assert.notEqual(without, before, `${await chip.innerText()} changes nothing`);
    await chip.click();
    assert.equal(await state(page), before);
  }
}

/** A step as reports write it: its time in seconds beside it where the study has a sampling time. */
const stepText = (k, results) => {
  const seconds = results.study.system.sampling_time;
  return seconds ? `k = ${k} (${k * seconds} s)` : `k = ${k}`;
};

async function trySliders(page, data, results) {
  for (const figure of data.figures.filter((one) => one.kind === 'projection' && one.projection.frames.length > 1)) {
    const article = await show(page, figure.id);
    const slider = article.getByRole('slider'), drawing = article.locator('.stage svg');
    const { frames } = figure.projection;
    const seen = frames.findLastIndex(({ sets }) => sets.some(({ x }) => x.length > 0));
    const first = seen < 0 ? frames.length - 1 : seen;
    assert.equal(await article.locator('output').innerText(), stepText(frames[first].k, results));
    if (first === 0) continue;
    const before = await drawing.innerHTML();
    await slider.focus();
    await page.keyboard.press('ArrowLeft');
    assert.equal(await article.locator('output').innerText(), stepText(frames[first - 1].k, results));
    assert.notEqual(await drawing.innerHTML(), before);
  }
}

const number = (value) => (value === 'inf' ? Infinity : value === '-inf' ? -Infinity : value);
function isNear(shown, value, what) {
  const wanted = number(value);
  if (!Number.isFinite(wanted)) return assert.equal(shown, wanted, what);
  assert.ok(Math.abs(shown - wanted) <= 1e-5 * Math.max(Math.abs(wanted), 1e-12), `${what}: ${shown} for ${wanted}`);
}
const parsed = (text) => {
  const digits = { '⁻': '-', '⁰': '0', '¹': '1', '²': '2', '³': '3', '⁴': '4', '⁵': '5', '⁶': '6', '⁷': '7', '⁸': '8', '⁹': '9' };
  const plain = text.replaceAll('−', '-').replace('∞', 'Infinity').replace(/^(-?)10(?=[⁻⁰¹²³⁴⁵⁶⁷⁸⁹])/, '$11·10')
    .replace(/·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)/, (_, power) => `e${[...power].map((c) => digits[c]).join('')}`);
  return Number(plain);
};

/** Bounds of the state: what the curves are made of, and what their table shows, against the results. */
async function compareBounds(page, data, results) {
  let compared = 0;
  const seconds = results.study.system.sampling_time ?? 1;
  const thinned = data.notes.some((note) => note.includes('thinned'));
  for (const figure of data.figures.filter((one) => /^bounds_\d+$/.test(one.id) && !thinned)) {
    const i = Number(figure.id.split('_')[1]) - 1;
    const article = await show(page, figure.id);
    const drawn = await page.evaluate((id) => Chart.getChart(document.querySelector(`#figure_${id} canvas`)).data.datasets
      .map((set) => ({ name: set.label, pipeline: set.series.pipeline, kind: set.series.kind, x: set.series.x, y: set.series.y, upper: set.series.upper, top: set.upper ?? false })), figure.id);
    for (const curve of drawn.filter((one) => one.kind === 'band' && !one.top && data.pipelines[one.pipeline] === one.name)) {
      const steps = new Map(results.pipelines[curve.pipeline].steps.map((step) => [step.k, step]));
      curve.x.forEach((time, at) => {
        const k = Math.round(time / seconds);
        assert.ok(Math.abs(time - k * seconds) <= 1e-9 * Math.max(1, time), `${figure.id}: ${time} is no step's time`);
        const hull = steps.get(k)?.hull;
        if (!hull || Number.isNaN(curve.y[at])) return;
        isNear(curve.y[at], hull.lower[i], `${figure.id}, ${curve.name}, k = ${k}`);
        isNear(curve.upper[at], hull.upper[i], `${figure.id}, ${curve.name}, k = ${k}`);
        ++compared;
      });
    }
    if (i > 0) continue;
    await openNumbers(article);
    const header = await article.locator('.numbers th').allInnerTexts();
    const row = await article.locator('.numbers tbody tr').last().locator('td').allInnerTexts();
    results.pipelines.forEach((pipeline) => {
      const hull = pipeline.steps?.find((step) => step.k === Math.round(Number(row[0]) / seconds))?.hull;
      const column = header.indexOf(`${pipeline.name}, lower`);
      if (!hull || column < 0) return;
      if (hull.lower[0] > hull.upper[0]) assert.equal(row[column], '–', `table, ${pipeline.name}: an empty set`);
      else isNear(parsed(row[column]), hull.lower[0], `table, ${pipeline.name}`);
    });
  }
  return compared;
}

for (const name of readdirSync(examples).filter((file) => file.endsWith('.json')).sort()) {
  test(name, async () => {
    const directory = join(scratch, name.replace('.json', ''));
    const results = run(join(examples, name), directory);
    const page = await open(browser, join(directory, 'report.html'));
    const data = await dataOf(page);
    assert.equal(await page.locator('h1').innerText(), results.title);
    assert.deepEqual(await page.locator('.chip').allInnerTexts(), results.pipelines.map((pipeline) => pipeline.name));
    assert.ok(data.figures.length > 0);
    for (const figure of data.figures) await show(page, figure.id);
    await trySwitches(page, data);
    await trySliders(page, data, results);
    const hulls = results.pipelines.some((pipeline) => pipeline.steps?.some((step) => step.hull));
    const compared = await compareBounds(page, data, results);
    if (hulls && !data.notes.some((note) => note.includes('thinned'))) assert.ok(compared > 0, 'no bound was compared');
    await close(page);
  });
}

/** Cells of a shown table, by row. */
const cells = (page, id) => page.locator(`#figure_${id} > .scroll tr`).evaluateAll((rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent)));
const leading = (text) => parsed(text.split(/ [±†%]/)[0]);
const isShownAs = (text, value, what) => assert.ok(Math.abs(leading(text) - value) <= 1e-3 * Math.abs(value), `${what}: ${text} for ${value}`);

test('the table of a run shows its numbers', async () => {
  const directory = join(scratch, 'numbers');
  const results = run(join(examples, 'descriptor_four_representations.json'), directory);
  const page = await open(browser, join(directory, 'report.html'));
  const table = (await dataOf(page)).figures.find((figure) => figure.kind === 'table' && figure.table.header.includes('mean radius'));
  const [header, ...rows] = await cells(page, table.id);
  assert.equal(rows.length, results.pipelines.length);
  rows.forEach((row, i) => {
    const { name, numbers } = results.pipelines[i];
    assert.equal(row[header.indexOf('pipeline')], name);
    isShownAs(row[header.indexOf('mean radius')], numbers.radius_mean, name);
    isShownAs(row[header.indexOf('mean volume')], numbers.volume_mean, name);
  });
  await close(page);
});

test('a sweep', async () => {
  const study = JSON.parse(readFileSync(join(examples, 'linear_two_states.json'), 'utf8'));
  study.data.simulate.steps = 30;
  study.sweep = [{ name: 'generators', path: '/pipelines/*/observer/max_generators', values: [6, 10, 20] }, { name: 'seed', path: '/data/simulate/seed', range: [1, 5] }];
  const file = join(scratch, 'sweep.json'), directory = join(scratch, 'sweep');
  writeFileSync(file, JSON.stringify(study));
  const results = run(file, directory);
  assert.equal(results.points.length, 60);
  const page = await open(browser, join(directory, 'report.html'));
  const data = await dataOf(page);
  for (const figure of data.figures) await show(page, figure.id);
  await trySwitches(page, data);
  const table = data.figures.find((figure) => figure.kind === 'table' && figure.table.header.includes('pipeline') && figure.table.header.includes('mean radius'));
  const [header, ...rows] = await cells(page, table.id);
  assert.equal(rows.length, 12);
  for (const row of rows) {
    const budget = [6, 10, 20].indexOf(Number(row[header.indexOf('generators')]));
    const name = row[header.indexOf('pipeline')], pipeline = results.pipelines.findIndex((one) => one.name === name);
    const values = results.points.filter((point) => point.pipeline === pipeline && point.at[0] === budget).map((point) => point.numbers.radius_mean);
    assert.equal(values.length, 5);
    isShownAs(row[header.indexOf('mean radius')], values.reduce((a, b) => a + b) / 5, `${name}, ${row[0]} generators`);
  }
  await close(page);
});

test('a study with hostile names', async () => {
  const name = '</script><script>alert("1")</script> \'<b>\' ünï';
  const study = JSON.parse(readFileSync(join(examples, 'linear_two_states.json'), 'utf8'));
  study.title = name;
  study.pipelines.forEach((pipeline, i) => { pipeline.name = `${name} ${i}`; });
  const place = join(scratch, 'ünï "quoted" & spaced');
  mkdirSync(place);
  writeFileSync(join(place, "it's a study.json"), JSON.stringify(study));
  run(join(place, "it's a study.json"), join(place, 'results'));
  const page = await open(browser, join(place, 'results', 'report.html'));
  assert.equal(await page.locator('h1').innerText(), name);
  assert.deepEqual(await page.locator('.chip').allInnerTexts(), study.pipelines.map((pipeline) => pipeline.name));
  assert.equal(await page.locator('b').count(), 0);
  await close(page);
});

test('ten pipelines over a thousand steps', async () => {
  const study = JSON.parse(readFileSync(join(examples, 'linear_two_states.json'), 'utf8'));
  study.data.simulate.steps = 1000;
  study.pipelines = Array.from({ length: 10 }, (_, i) => ({ ...structuredClone(study.pipelines[i % study.pipelines.length]), name: `pipeline ${i + 1}` }));
  const file = join(scratch, 'ten.json');
  writeFileSync(file, JSON.stringify(study));
  run(file, join(scratch, 'ten'));
  const report = join(scratch, 'ten', 'report.html');
  const times = [];
  for (let i = 0; i < 5; ++i) {
    const start = performance.now();
    const page = await open(browser, report);
    await page.locator('canvas').first().scrollIntoViewIfNeeded();  // notes may stand above it
    await page.waitForFunction(() => [...document.querySelectorAll('canvas')].some((canvas) => Chart.getChart(canvas)));
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    times.push(Math.round(performance.now() - start));
    await close(page);
  }
  const size = readFileSync(report).length;
  console.log(`10 pipelines × 1000 steps: opened and drawn in ${times.sort((a, b) => a - b).join(', ')} ms, ${(size / 1e6).toFixed(2)} MB`);
  assert.ok(size < 5e6);
});
