// SPDX-License-Identifier: GPL-3.0-or-later
// The pictures of reports in the README: scripts/screenshots. Arguments: CORDON SOURCES SCRATCH
import { execFileSync } from 'node:child_process';
import { mkdirSync, rmSync, statSync } from 'node:fs';
import { join } from 'node:path';

import { launch, open } from './browser.mjs';

const [cordon, sources, scratch] = process.argv.slice(2);
const images = join(sources, 'docs', 'images');
/** Name of the picture, study, and the section at the top of the picture; none: the head of the page. */
const pictures = [
  ['report_estimation', 'descriptor_four_representations', 'Sets'],
  ['report_diagnosis', 'cstr_actuator_faults', 'Diagnosis'],
  ['report_design', 'active_diagnosis_descriptor', 'Designed inputs'],
  ['report_sweep', 'compare_representations', null],
];

rmSync(scratch, { recursive: true, force: true });
mkdirSync(scratch, { recursive: true });
mkdirSync(images, { recursive: true });
const browser = await launch();
for (const [name, study, section] of pictures) {
  const directory = join(scratch, name);
  execFileSync(cordon, ['run', join(sources, 'examples', 'studies', `${study}.json`), '--out', directory, '--quiet'], { stdio: 'inherit' });
  const page = await open(browser, join(directory, 'report.html'), { viewport: { width: 1200, height: 900 }, colorScheme: 'light', reducedMotion: 'reduce' });
  if (section !== null) {
    await page.getByRole('heading', { level: 2, name: section, exact: true }).evaluate((heading) => heading.scrollIntoView());
    await page.waitForTimeout(300);
  }
  await page.waitForFunction(() => [...document.querySelectorAll('canvas')].filter((canvas) => {
    const box = canvas.getBoundingClientRect();
    return box.bottom > 0 && box.top < innerHeight && !Chart.getChart(canvas);
  }).length === 0);
  await page.waitForTimeout(300);
  const file = join(images, `${name}.png`);
  await page.screenshot({ path: file });
  console.log(`${file}: ${Math.round(statSync(file).size / 1000)} kB`);
  await page.context().close();
}
await browser.close();
