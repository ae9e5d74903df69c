// SPDX-License-Identifier: GPL-3.0-or-later
// The first minutes of somebody with two meshes, in headless Chromium: node try.mjs CHROMIUM PALPATE TOOL OTHER [FOLDER for pictures]
// `palpate try` with its live page and its report, then the mouse as the hand: pages load without an error on the console, the
// unit is guessed, contact is felt, a drag moves the tool and shows a force.
import assert from 'node:assert/strict';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { Chromium } from './chromium.mjs';
import { comesTrue, drag, findTool, loadPage, newtons, sleep, start, textOf } from './live_page.mjs';
import { checkOverStage } from './over_stage.mjs';

const [program, palpate, tool, other, pictures] = process.argv.slice(2);
const kRun_s = 40;  // a page that is drawn without graphics hardware may take ten to come
const folder = mkdtempSync(join(tmpdir(), 'palpate-try-'));
const at = (name) => join(folder, name);

async function picture(browser, name, part = 'body') {
  if (!pictures) return;
  for (const scheme of ['dark', 'light']) {
    await browser.scheme(scheme);
    await sleep(500);
    writeFileSync(join(pictures, `${name}_${scheme}.png`), await browser.picture(part));
  }
}

/// From the tool towards the other body, as the page first shows them: {x, y} of length 1.
async function wayOnScreen(browser) {
  const places = await browser.value(`(() => {
    const { view } = JSON.parse(document.getElementById('data').textContent);
    const first = (text) => new Float32Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
    return view.bodies.map(({ track, image }) => [0, 1, 2].map((k) => first(track)[k] + view.images[image].centre_m[k]));
  })()`);
  const way = places[1].map((x, k) => x - places[0][k]);
  const dot = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);
  const [x, y] = [dot(way, [0.853, 0.521, 0]), -dot(way, [0.203, -0.332, 0.921])];  // the camera's right and up
  const length = Math.hypot(x, y);
  return { x: x / length, y: y / length };
}

async function tryMeshes(browser) {
  const began = Date.now();
  const run = start(palpate, 'try', resolve(tool), resolve(other), '-o', folder, '--no-browser', '--seconds', String(kRun_s));
  await loadPage(browser, run, 1200);
  await comesTrue('no contact is felt', async () => (await newtons(browser)) > 0.02, 400);
  await checkOverStage(browser);
  const status = await run.exited;
  const seconds = (Date.now() - began) / 1000;
  assert.ok(status === 0 || status === 5, `exit status ${status}: ${run.err}`);  // 5: a busy machine missed deadlines
  assert.match(run.out, /in millimetres by its size/);
  assert.ok(existsSync(at('report.html')));
  console.log(`palpate try: ${seconds.toFixed(1)} s, ${kRun_s} of them the run`);
  assert.deepEqual(browser.errors, []);
}

async function lookAtReport(browser) {
  await browser.load(pathToFileURL(at('report.html')).href);
  await checkOverStage(browser);
  assert.equal(await browser.value('document.getElementById("arrow").hidden'), false);
  await picture(browser, 'try_report', '#view');
  assert.deepEqual(browser.errors, []);
}

/// A machine that is too busy to hold the loop up ends the force with a fault: then it is no test.
async function pullByMouse(browser, tries = 3) {
  const run = start(palpate, 'run', at('scene.toml'), '--device', 'mouse', '--view', '--no-browser', '--json');
  try {
    await loadPage(browser, run);
    await comesTrue('nothing is rendered', async () => (await textOf(browser, 'state')) === 'rendering');
    await browser.value('document.getElementById("fit").click()');
    await browser.drawn();
    const way = await wayOnScreen(browser);
    const from = await findTool(browser);
    const before = await browser.picture('#stage');
    await drag(browser, from, { x: from.x + 160 * way.x, y: from.y + 160 * way.y });
    await comesTrue('no force', async () => (await newtons(browser)) > 0.02);
    await sleep(1000);
    const held = await newtons(browser);
    assert.ok(held > 0.02, `${held} N`);
    assert.equal(await browser.value('document.getElementById("arrow").hidden'), false);
    assert.ok(!before.equals(await browser.picture('#stage')), 'the tool does not move');
    console.log(`a drag of the mouse: ${held} N, ${await textOf(browser, 'contacts')}`);
    await picture(browser, 'try_mouse');
    assert.deepEqual(browser.errors, []);
  } catch (error) {
    if (tries > 1 && /^fault/.test(await textOf(browser, 'state'))) {
      run.child.kill('SIGKILL');
      return pullByMouse(browser, tries - 1);
    }
    throw error;
  } finally {
    run.child.kill('SIGKILL');
  }
}

let browser;
try {
  browser = await Chromium.open(program);
  await browser.resize(1400, 900);
  await tryMeshes(browser);
  await lookAtReport(browser);
  await pullByMouse(browser);
} finally {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
}
