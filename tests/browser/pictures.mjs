// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of a report for the documentation: node pictures.mjs CHROMIUM REPORT.html FOLDER
import { writeFileSync } from 'node:fs';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { Chromium } from './chromium.mjs';

const [program, report, folder] = process.argv.slice(2);
const browser = await Chromium.open(program);
await browser.resize(1200, 900);
await browser.load(pathToFileURL(resolve(report)).href);
const sections = await browser.value(
  '[...document.querySelectorAll("section:not([hidden])")].map((section) => section.id)',
);
for (const scheme of ['light', 'dark']) {
  await browser.scheme(scheme);
  for (const id of sections) writeFileSync(resolve(folder, `${id}_${scheme}.png`), await browser.picture(`#${id}`));
}
await browser.close();
