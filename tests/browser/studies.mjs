// SPDX-License-Identifier: GPL-3.0-or-later
// Reports of real runs: browser_test studies.mjs CORDON SOURCES SCRATCH
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
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
    // 4: a guarantee was violated; 5: a solver gave no answer in its limit. The results are there all the same.
    if (![4, 5].includes(error.status)) throw new Error(`cordon run ${study}: ${error.stderr}`);
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

async function trySliders(page, data) {
  for (const figure of data.figures.filter((one) => one.kind === 'projection' && one.projection.frames.length > 1)) {
    const article = await show(page, figure.id);
    const slider = article.getByRole('slider'), drawing = article.locator('.stage svg');
    const last = figure.projection.frames.at(-1).k, previous = figure.projection.frames.at(-2).k;
    assert.equal(await article.locator('output').innerText(), `k = ${last}`);
    const before = await drawing.innerHTML();
    await slider.focus();
    await page.keyboard.press('ArrowLeft');
    assert.equal(await article.locator('output').innerText(), `k = ${previous}`);
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
  const thinned = data.notes.some((note) => note.includes('thinned'));
  for (const figure of data.figures.filter((one) => /^bounds_\d+$/.test(one.id) && !thinned)) {
    const i = Number(figure.id.split('_')[1]) - 1;
    const article = await show(page, figure.id);
    const drawn = await page.evaluate((id) => Chart.getChart(document.querySelector(`#figure_${id} canvas`)).data.datasets
      .map((set) => ({ name: set.label, pipeline: set.series.pipeline, kind: set.series.kind, x: set.series.x, y: set.series.y, upper: set.series.upper, top: set.upper ?? false })), figure.id);
    for (const curve of drawn.filter((one) => one.kind === 'band' && !one.top && data.pipelines[one.pipeline] === one.name)) {
      const steps = new Map(results.pipelines[curve.pipeline].steps.map((step) => [step.k, step]));
      curve.x.forEach((k, at) => {
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
      const hull = pipeline.steps?.find((step) => step.k === Number(row[0]))?.hull;
      const column = header.indexOf(`${pipeline.name}, lower`);
      if (hull && column > 0 && row[column] !== '') isNear(parsed(row[column]), hull.lower[0], `table, ${pipeline.name}`);
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
    await trySliders(page, data);
    const hulls = results.pipelines.some((pipeline) => pipeline.steps?.some((step) => step.hull));
    const compared = await compareBounds(page, data, results);
    if (hulls && !data.notes.some((note) => note.includes('thinned'))) assert.ok(compared > 0, 'no bound was compared');
    await close(page);
  });
}

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
    await page.waitForFunction(() => [...document.querySelectorAll('canvas')].some((canvas) => Chart.getChart(canvas)));
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    times.push(Math.round(performance.now() - start));
    await close(page);
  }
  const size = readFileSync(report).length;
  console.log(`10 pipelines × 1000 steps: opened and drawn in ${times.sort((a, b) => a - b).join(', ')} ms, ${(size / 1e6).toFixed(2)} MB`);
  assert.ok(size < 5e6);
});
