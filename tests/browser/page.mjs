// SPDX-License-Identifier: GPL-3.0-or-later
// Pages of reports made by hand, with every kind of figure: browser_test page.mjs REPORT_SAMPLES SCRATCH
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, rmSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { close, colours, curves, dataOf, launch, open, openNumbers, picture, show } from './browser.mjs';

const [samples, scratch] = process.env.CORDON_TEST_ARGUMENTS.split('\n');
const file = (name) => join(scratch, `${name}.html`);
let browser;

before(async () => {
  rmSync(scratch, { recursive: true, force: true });
  execFileSync(samples, [scratch]);
  browser = await launch();
});
after(() => browser.close());

const hostile = '</script><script>alert(1)</script> "quoted" \'single\' <b>&amp; {{data}} ünï — 推定 🛰';
const visibleRows = (page) => page.locator('#figure_table tbody tr:visible').allInnerTexts();
const shapes = (page) => page.evaluate(() => [...document.querySelectorAll('#figure_states .stage polygon')].map((one) => one.getAttribute('points')));

test('every figure is there, in order, under its section', async () => {
  const page = await open(browser, file('every_kind'));
  assert.equal(await page.title(), 'Every kind of figure');
  assert.deepEqual(await page.locator('main h2').allInnerTexts(), ['Results', 'Sizes', 'States', 'Diagnosis']);
  assert.deepEqual(await page.locator('main article').evaluateAll((all) => all.map((one) => one.id)),
    ['table', 'radius', 'volume', 'state_1', 'states', 'budgets', 'modes', 'tubes'].map((id) => `figure_${id}`));
  assert.deepEqual(await page.locator('.note').allInnerTexts(), ['A note that comes first.']);
  assert.equal(await page.locator('#facts').innerText(), '2 pipelines · 8 figures · cordon 0.1.0');
  await page.getByText('The study with every default').click();
  assert.match(await page.locator('#study pre').innerText(), /"cordon": 1/);
  assert.match(await page.locator('#versions').innerText(), /a machine/);
  await close(page);
});

test('axes have the ticks and texts of the exported figures', async () => {
  const page = await open(browser, file('every_kind'));
  const axes = JSON.parse(readFileSync(join(scratch, 'axes.json'), 'utf8'));
  assert.ok(axes.length > 50);
  const own = await page.evaluate((all) => all.map(({ lower, upper, ticks, texts, log_ticks: logs, log_texts: logTexts }) => ({
    lower, upper,
    ...(ticks && { digits: digitsWithin(lower, upper) }),
    ...(ticks && { ticks: ticks.map(([count]) => [count, niceTicks(lower, upper, count), niceTicks(lower, upper, count, true), uprightTicks(lower, upper, count)]) }),
    ...(texts && { texts: texts.map(([tick]) => [tick, short(tick, digitsWithin(lower, upper)), short(tick / 3)]) }),
    ...(logs && { log_ticks: logTicks(lower, upper) }),
    ...(logTexts && { log_texts: logTexts.map(([tick]) => [tick, logText(tick, hasPowers(lower, upper))]) }),
  })), axes);
  for (const [i, axis] of axes.entries()) assert.deepEqual(own[i], axis);
  await close(page);
  for (const name of ['every_kind', 'far']) {
    const report = await open(browser, file(name));
    for (const { id } of (await dataOf(report)).figures.filter(({ kind }) => kind === 'plot')) {
      await show(report, id);
      const shown = await report.evaluate((one) => Chart.getChart(document.querySelector(`#figure_${one} canvas`)).scales.y.ticks.map(({ label }) => label), id);
      const drawn = readFileSync(join(scratch, `${id}.svg`), 'utf8').matchAll(/<text[^>]*class="soft"[^>]*text-anchor="end">([^<]*)<\/text>/g);
      assert.deepEqual(shown, [...drawn].map(([, text]) => text), `${name}: ${id}`);
    }
    await close(report);
  }
});

test('a figure is drawn when it is seen, and not before', async () => {
  const page = await open(browser, file('large'));
  const count = () => page.evaluate(() => [...document.querySelectorAll('canvas')].filter((canvas) => Chart.getChart(canvas)).length);
  await show(page, 'state_1');
  assert.ok(await count() < 8);
  await show(page, 'volume');
  assert.equal((await curves(page, 'volume')).length, 10);
  await close(page);
});

test('a switch takes its pipeline out of every figure, and brings it back', async () => {
  const page = await open(browser, file('every_kind'));
  const plots = ['radius', 'volume', 'state_1', 'budgets'];
  for (const id of plots) await show(page, id);
  const seen = await Promise.all(plots.map((id) => picture(page, id)));
  for (const [name, other, rows] of [['first', 'second', 2], ['second', 'first', 2]]) {
    const chip = page.getByRole('button', { name, exact: true });
    assert.equal(await chip.getAttribute('aria-pressed'), 'true');
    await chip.click();
    assert.equal(await chip.getAttribute('aria-pressed'), 'false');
    for (const [i, id] of plots.entries()) assert.notEqual(await picture(page, id), seen[i], `${id} without ${name}`);
    const number = name === 'first' ? '1' : '2';
    for (const [curve, shown] of await curves(page, 'radius')) assert.equal(shown, curve !== `radius ${number}`);
    for (const [curve, shown] of await curves(page, 'state_1')) assert.equal(shown, curve !== `hull ${number}`);
    assert.equal((await visibleRows(page)).length, rows);
    assert.ok((await visibleRows(page))[0].startsWith(other));
    assert.equal(await page.locator('#figure_modes').isVisible(), name === 'first');
    assert.equal(await page.locator('#figure_states .stage g[data-pipeline]').count(), 1);
    await chip.click();
    for (const [i, id] of plots.entries()) assert.equal(await picture(page, id), seen[i], `${id} with ${name} again`);
  }
  assert.equal((await visibleRows(page)).length, 3);
  await close(page);
});

test('switches work from the keyboard', async () => {
  const page = await open(browser, file('every_kind'));
  await page.getByRole('button', { name: 'second', exact: true }).focus();
  await page.keyboard.press('Space');
  assert.equal((await visibleRows(page)).length, 2);
  await page.keyboard.press('Enter');
  assert.equal((await visibleRows(page)).length, 3);
  const outline = await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle);
  assert.equal(outline, 'solid');
  await close(page);
});

test('all and none', async () => {
  const page = await open(browser, file('large'));
  await show(page, 'state_1');
  await page.getByRole('button', { name: 'None' }).click();
  assert.deepEqual((await curves(page, 'state_1')).filter(([, shown]) => shown), [['true state', true]]);
  await page.getByRole('button', { name: 'All', exact: true }).click();
  assert.ok((await curves(page, 'state_1')).every(([, shown]) => shown));
  await close(page);
});

test('the slider moves through time', async () => {
  const page = await open(browser, file('every_kind'));
  const figure = await show(page, 'states');
  const told = () => figure.locator('.told[aria-live]').innerText();
  const k = () => figure.locator('output').innerText();
  const slider = figure.getByRole('slider');
  assert.equal(await k(), 'k = 11');
  assert.match(await told(), /Proven empty: second\./);
  const last = await shapes(page);
  assert.equal(last.length, 1);
  await slider.focus();
  await page.keyboard.press('ArrowLeft');
  assert.equal(await k(), 'k = 10');
  assert.equal(await slider.getAttribute('aria-valuetext'), 'k = 10');
  assert.notDeepEqual(await shapes(page), last);
  await page.keyboard.press('Home');
  assert.equal(await k(), 'k = 0');
  assert.equal((await shapes(page)).length, 2);
  assert.deepEqual(await figure.locator('.stage line.open').evaluateAll((all) => all.map((line) => line.getAttribute('stroke-dasharray'))), ['2 5']);
  assert.equal(await figure.locator('.stage g line:not(.open)[stroke-dasharray]').count(), 0);
  assert.match(await told(), /continues beyond the frame \(second\)/);
  assert.match(await told(), /True state: \(−1, 0\)/);
  await page.keyboard.press('End');
  assert.deepEqual(await shapes(page), last);
  await close(page);
});

test('sets open at the last step that has a picture', async () => {
  const page = await open(browser, file('every_kind'));
  const opened = (empty) => page.evaluate((count) => {
    const figure = structuredClone(data.figures.find(({ id }) => id === 'states'));
    for (const frame of figure.projection.frames.slice(-count))
      for (const set of frame.sets) set.x = set.y = set.open = [];
    const view = projectionView(figure);
    view.create();
    const [, slider, output] = view.parts.find((part) => part.className === 'slider').childNodes;
    return [output.textContent, Number(slider.max) - Number(slider.value)];
  }, empty);
  assert.deepEqual(await opened(2), ['k = 9', 2]);
  assert.deepEqual(await opened(100), ['k = 11', 0]);
  await close(page);
});

test('sets are drawn where their coordinates are', async () => {
  const page = await open(browser, file('every_kind'));
  await show(page, 'states');
  const data = (await dataOf(page)).figures.find((figure) => figure.id === 'states').projection.frames.at(-1);
  const box = await page.evaluate(() => {
    const frame = document.querySelector('#figure_states .stage .frame');
    return ['x', 'y', 'width', 'height'].map((name) => Number(frame.getAttribute(name)));
  });
  const points = (await shapes(page))[0].split(' ').map((pair) => pair.split(',').map(Number));
  points.forEach(([x, y], i) => {
    assert.ok(Math.abs(data.left + ((x - box[0]) / box[2]) * (data.right - data.left) - data.sets[0].x[i]) < 1e-6);
    assert.ok(Math.abs(data.top - ((y - box[1]) / box[3]) * (data.top - data.bottom) - data.sets[0].y[i]) < 1e-6);
  });
  await close(page);
});

test('ticks far from the origin are told apart, and none is cut off', async () => {
  const page = await open(browser, file('far'));
  await show(page, 'far_state');
  const labels = await page.evaluate(() => {
    const { scales } = Chart.getChart(document.querySelector('#figure_far_state canvas'));
    return scales.y.ticks.map((tick) => tick.label);
  });
  assert.ok(labels.length >= 4);
  assert.equal(new Set(labels).size, labels.length, labels.join(' '));
  await show(page, 'far_sets');
  const texts = await page.evaluate(() => {
    const stage = document.querySelector('#figure_far_sets .stage').getBoundingClientRect();
    return [...document.querySelectorAll('#figure_far_sets .stage text')].map((text) => {
      const box = text.getBoundingClientRect();
      return { text: text.textContent, cut: box.left < stage.left - 1 || box.right > stage.right + 1 };
    });
  });
  assert.ok(texts.length >= 8);
  assert.equal(new Set(texts.map(({ text }) => text)).size, texts.length);
  assert.deepEqual(texts.filter(({ cut }) => cut), []);
  await close(page);
});

test('curves are the data: gaps stay gaps, infinity leaves the figure', async () => {
  const page = await open(browser, file('every_kind'));
  await show(page, 'radius');
  const drawn = await page.evaluate(() => {
    const chart = Chart.getChart(document.querySelector('#figure_radius canvas'));
    return { values: chart.data.datasets[1].data.map((point) => point.y), top: chart.scales.y.max, upper: chart.scales.y.getPixelForValue(2) < chart.scales.y.getPixelForValue(1) };
  });
  const given = (await dataOf(page)).figures.find((figure) => figure.id === 'radius').plot.series[1].y;
  given.forEach((value, k) => {
    if (k === 31) assert.ok(drawn.values[k] > drawn.top);
    else assert.equal(drawn.values[k], value);
  });
  assert.equal(drawn.values[30], null);
  assert.ok(drawn.upper);
  await close(page);
});

test('a value of steps holds until the next, and a band is an area', async () => {
  const page = await open(browser, file('every_kind'));
  await show(page, 'volume');
  const { y } = await page.evaluate(() => Chart.getChart(document.querySelector('#figure_volume canvas')).data.datasets[1].data[30]);
  const next = await page.evaluate(() => Chart.getChart(document.querySelector('#figure_volume canvas')).data.datasets[1].data[31].y);
  const [on, off] = await colours(page, 'volume', [[30.75, y], [30.25, next]]);
  assert.ok(on[3] > 100, 'the value before the step');
  assert.equal(off[3], 0, 'not yet the value after it');
  await show(page, 'state_1');
  const [inside, between, outside] = await colours(page, 'state_1', [[62.5, 0.2], [62.5, 0.62], [62.5, 3]]);
  assert.ok(inside[3] > 0);
  assert.ok(between[3] > 0);
  assert.ok(inside[3] > between[3], 'where two bands lie on each other it is darker');
  assert.equal(outside[3], 0);
  await close(page);
});

test('a logarithmic axis: what has no logarithm lies below it', async () => {
  const page = await open(browser, file('every_kind'));
  await show(page, 'volume');
  const [value, lowest, ticks] = await page.evaluate(() => {
    const chart = Chart.getChart(document.querySelector('#figure_volume canvas'));
    return [chart.data.datasets[0].data[10].y, chart.scales.y.min, chart.scales.y.ticks.map((tick) => tick.label)];
  });
  assert.ok(value > 0 && value < lowest);
  assert.deepEqual(ticks, ['0.1', '0.2', '0.5', '1', '2']);
  await close(page);
});

test('numbers of a figure as a table and as a file', async () => {
  const page = await open(browser, file('every_kind'));
  const figure = await show(page, 'state_1');
  await openNumbers(figure);
  assert.deepEqual(await figure.locator('thead th').allInnerTexts(), ['k', 'hull 1, lower', 'hull 1, upper', 'hull 2, lower', 'hull 2, upper', 'true state']);
  assert.equal(await figure.locator('tbody tr').count(), 101);
  assert.deepEqual(await figure.locator('tbody tr').first().locator('td').allInnerTexts(), ['0', '−0.5', '0.5', '−0.9', '0.9', '0']);
  const waiting = page.waitForEvent('download');
  await figure.getByRole('button', { name: 'Download as CSV' }).click();
  const download = await waiting;
  assert.equal(download.suggestedFilename(), 'state_1.csv');
  const lines = readFileSync(await download.path(), 'utf8').trimEnd().split('\n');
  assert.equal(lines.length, 102);
  assert.equal(lines[0], 'k,"hull 1, lower","hull 1, upper","hull 2, lower","hull 2, upper",true state');
  assert.equal(lines[1], '0,-0.5,0.5,-0.9,0.9,0');
  const timeline = page.locator('#figure_modes');
  await openNumbers(timeline);
  assert.deepEqual(await timeline.locator('tbody tr').first().locator('td').allInnerTexts(), ['healthy', '0', '20', 'monitored']);
  await close(page);
});

test('a column sorts its table', async () => {
  const page = await open(browser, file('every_kind'));
  const column = () => page.locator('#figure_table tbody td:nth-child(2)').allInnerTexts();
  await page.getByRole('button', { name: 'mean radius' }).click();
  assert.deepEqual(await column(), ['1.5', '1.875', '2.25']);
  await page.getByRole('button', { name: 'mean radius' }).click();
  assert.deepEqual(await column(), ['2.25', '1.875', '1.5']);
  assert.equal(await page.locator('#figure_table th:nth-child(2)').getAttribute('aria-sort'), 'descending');
  assert.equal(await page.locator('#figure_table td.best').innerText(), '1.5');
  await close(page);
});

const background = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor);

test('light and dark, by the system and by the button', async () => {
  const light = await open(browser, file('every_kind'), { colorScheme: 'light' });
  const dark = await open(browser, file('every_kind'), { colorScheme: 'dark' });
  for (const page of [light, dark]) await show(page, 'radius');
  assert.notEqual(await background(light), await background(dark));
  assert.notEqual(await picture(light, 'radius'), await picture(dark, 'radius'));
  await light.getByRole('button', { name: 'Dark' }).click();
  assert.equal(await background(light), await background(dark));
  assert.equal(await picture(light, 'radius'), await picture(dark, 'radius'));
  await dark.emulateMedia({ colorScheme: 'light' });
  await dark.waitForFunction(() => document.documentElement.dataset.theme === 'light');
  await close(light);
  await close(dark);
});

test('paper is white, has every figure and no controls', async () => {
  const page = await open(browser, file('every_kind'), { colorScheme: 'dark' });
  const pdf = await page.pdf({ format: 'A4', printBackground: true });
  assert.ok(pdf.length > 20000);
  assert.ok((await page.evaluate(() => [...document.querySelectorAll('canvas')].every((canvas) => Chart.getChart(canvas)))), 'every curve is drawn');
  await page.waitForFunction(() => document.documentElement.dataset.theme === 'dark');
  await page.emulateMedia({ media: 'print' });
  assert.equal(await background(page), 'rgb(255, 255, 255)');
  assert.equal(await page.getByRole('button', { name: 'Print' }).isVisible(), false);
  assert.equal(await page.getByRole('slider').isVisible(), false);
  assert.equal(await page.locator('#figure_budgets').isVisible(), true);
  await close(page);
});

test('hostile names are shown, not executed', async () => {
  const page = await open(browser, file('hostile'));
  assert.equal(await page.title(), hostile);
  assert.equal(await page.locator('h1').innerText(), hostile);
  assert.equal(await page.locator('.chip').first().innerText(), hostile);
  assert.equal(await page.locator('main h3').first().innerText(), hostile);
  assert.equal(await page.locator('#figure_table th').first().innerText(), hostile);
  assert.equal(await page.locator('b').count(), 0);
  assert.equal(await page.locator('script:not([type])').count(), 5);
  for (const figure of (await dataOf(page)).figures) await show(page, figure.id);
  assert.equal((await curves(page, 'radius'))[0][0], hostile);
  assert.ok((await page.locator('#figure_modes .plate svg text').allTextContents()).some((text) => text.startsWith('</script><script>')));
  await page.locator('.chip').first().click();
  for (const summary of await page.locator('.numbers summary').all()) await summary.click();
  const waiting = page.waitForEvent('download');
  await page.locator('#figure_budgets').getByRole('button', { name: 'Download as CSV' }).click();
  const header = readFileSync(await (await waiting).path(), 'utf8').split('\n')[0];
  const field = `"${hostile.replaceAll('"', '""')}"`;
  assert.equal(header, `${field},${field}`);
  await close(page);
});

test('everything has a name for those who do not see it', async () => {
  const page = await open(browser, file('every_kind'));
  for (const figure of (await dataOf(page)).figures) await show(page, figure.id);
  const nameless = await page.evaluate(() => [...document.querySelectorAll('canvas, [role="img"], input, button, [role="region"], nav, section')]
    .filter((one) => !(one.getAttribute('aria-label') || one.getAttribute('aria-labelledby') || one.querySelector('title') || one.textContent.trim()))
    .map((one) => one.outerHTML));
  assert.deepEqual(nameless, []);
  assert.match(await page.locator('#figure_radius canvas').getAttribute('aria-label'), /^Radius\. 2 curves: radius 1, radius 2\. k: 0 to 100\. radius: 0 to 2\.\d+\.$/);
  const levels = await page.locator('h1, h2, h3').evaluateAll((all) => all.map((one) => Number(one.tagName[1])));
  assert.ok(levels.every((level, i) => i === 0 ? level === 1 : level <= levels[i - 1] + 1));
  const ids = await page.locator('[id]').evaluateAll((all) => all.map((one) => one.id));
  assert.equal(new Set(ids).size, ids.length);
  await close(page);
});

test('a narrow window scrolls downwards only', async () => {
  for (const name of ['every_kind', 'hostile', 'large']) {
    const page = await open(browser, file(name), { viewport: { width: 380, height: 800 } });
    for (const figure of (await dataOf(page)).figures) await show(page, figure.id);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth), name);
    await close(page);
  }
});

test('ten pipelines over a thousand steps open quickly', async () => {
  const times = [];
  for (let i = 0; i < 5; ++i) {
    const start = performance.now();
    const page = await open(browser, file('large'));
    await show(page, 'state_1');
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    times.push(Math.round(performance.now() - start));
    await close(page);
  }
  const size = statSync(file('large')).size;
  console.log(`10 pipelines × 1000 steps: opened and drawn in ${times.sort((a, b) => a - b).join(', ')} ms, ${(size / 1e6).toFixed(2)} MB`);
  assert.ok(size < 5e6);
});

test('drawings for papers are shown by the browser', async () => {
  for (const name of ['table', 'radius', 'volume', 'state_1', 'states', 'budgets', 'modes', 'tubes', 'far_state', 'far_sets']) {
    const page = await open(browser, join(scratch, `${name}.svg`));
    assert.equal(await page.evaluate(() => document.documentElement.nodeName), 'svg');
    const outside = await page.evaluate(() => {
      const [, , width, height] = document.documentElement.getAttribute('viewBox').split(' ').map(Number);
      return [...document.querySelectorAll('text')].filter((text) => {
        const box = text.getBoundingClientRect(), all = document.documentElement.getBoundingClientRect();
        const scale = all.width / width;
        return box.left < all.left - 1 || box.right > all.left + width * scale + 1 || box.top < all.top - 1 || box.bottom > all.top + height * scale + 1;
      }).map((text) => text.textContent);
    });
    assert.deepEqual(outside, [], `${name}: texts beyond the edge`);
    await close(page);
  }
});
