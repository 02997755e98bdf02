// SPDX-License-Identifier: GPL-3.0-or-later
// A headless browser, and pages that must neither complain nor ask for anything.
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const { chromium } = createRequire(join(process.env.CORDON_BROWSER_TOOLS, 'package.json'))('playwright-core');

export const launch = () => chromium.launch({
  executablePath: process.env.CORDON_BROWSER,
  args: process.getuid() === 0 ? ['--no-sandbox'] : [],  // Chromium has no sandbox for root
});

/** Opens a file; `page.complaints` collects errors, dialogs and requests for anything else. */
export async function open(browser, file, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, acceptDownloads: true, ...options });
  const page = await context.newPage();
  const url = pathToFileURL(file).href;
  page.complaints = [];
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) page.complaints.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => page.complaints.push(`error: ${error.message}`));
  page.on('dialog', (dialog) => { page.complaints.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  page.on('request', (request) => {
    if (request.url().split('#')[0] !== url && !request.url().startsWith('blob:')) page.complaints.push(`request: ${request.url()}`);
  });
  await page.goto(url);
  return page;
}

export async function close(page) {
  assert.deepEqual(page.complaints, []);
  await page.context().close();
}

/** Brings a figure into the window, so that it is drawn. */
export async function show(page, id) {
  const figure = page.locator(`#figure_${id}`);
  await figure.scrollIntoViewIfNeeded();
  await page.waitForFunction((name) => {
    const canvas = document.querySelector(`#figure_${name} canvas`);
    const stage = document.querySelector(`#figure_${name} .stage svg`);
    return (canvas === null || Chart.getChart(canvas) !== undefined) && (stage === null || stage.childElementCount > 0);
  }, id);
  return figure;
}

export const dataOf = (page) => page.evaluate(() => JSON.parse(document.getElementById('report-data').textContent));

/** Which curves of a drawn figure are shown: [name, shown] of each of its datasets. */
export const curves = (page, id) => page.evaluate((name) => {
  const chart = Chart.getChart(document.querySelector(`#figure_${name} canvas`));
  return chart.data.datasets.map((set, i) => [set.label, chart.isDatasetVisible(i)]);
}, id);

/** What a canvas shows; another picture is another text. */
export const picture = (page, id) => page.evaluate((name) => document.querySelector(`#figure_${name} canvas`).toDataURL(), id);

/** The colours of a curve's canvas at places of its axes: [red, green, blue, alpha] for each [x, y]. */
export const colours = (page, id, places) => page.evaluate(([name, all]) => {
  const canvas = document.querySelector(`#figure_${name} canvas`), chart = Chart.getChart(canvas);
  const copy = document.createElement('canvas');
  copy.width = canvas.width;
  copy.height = canvas.height;
  const context = copy.getContext('2d', { willReadFrequently: true });
  context.drawImage(canvas, 0, 0);
  return all.map(([x, y]) => [...context.getImageData(chart.scales.x.getPixelForValue(x), chart.scales.y.getPixelForValue(y), 1, 1).data]);
}, [id, places]);

/** Opens the numbers of a figure. */
export async function openNumbers(figure) {
  await figure.locator('.numbers summary').click();
  await figure.locator('.numbers table').waitFor();
}
