// SPDX-License-Identifier: GPL-3.0-or-later
// The live view in headless Chromium: node live.mjs CHROMIUM PALPATE [FOLDER for pictures]
// A ball over a ball, on the mouse: the page loads without an error and asks nobody else, a drag moves
// the tool until it is held off and shows the force, Shift turns it, the wheel takes it away, a gamepad
// leads it too; the loop allocates nothing meanwhile, and the page says when the run has ended.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { Chromium } from './chromium.mjs';
import { comesTrue, drag, findTool, loadPage, newtons, sleep, start, textOf } from './live_page.mjs';
import { checkOverStage, readContact } from './over_stage.mjs';

const [program, palpate, pictures] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), 'palpate-live-'));
const at = (name) => join(folder, name);
const command = (...args) => execFileSync(palpate, args, { stdio: ['ignore', 'ignore', 'inherit'] });

function makeScene() {
  command('make-model', 'golf_ball', '-o', at('ball.ply'), '--triangles', '20000');
  command('bake', at('ball.ply'), '-o', at('ball.palp'), '--quiet', '--engine', 'both');
  const radius = JSON.parse(execFileSync(palpate, ['inspect', at('ball.palp'), '--json'])).radius_m;
  writeFileSync(at('scene.toml'), `
[engine]
engine = "regions"
delta_m = ${0.02 * radius}
budget_us = 400
[force]
stiffness_N_per_m = 800.0
[[body]]
name = "tool"
image = "ball.palp"
role = "tool"
position = [0.0, 0.0, ${2.1 * radius}]
[[body]]
name = "table"
image = "ball.palp"
`);
}

async function checkLooks(browser) {
  for (const scheme of ['light', 'dark']) {
    await browser.scheme(scheme);
    await sleep(300);
    if (pictures) writeFileSync(join(pictures, `live_${scheme}.png`), await browser.picture());
  }
  await browser.resize(390, 800);
  await sleep(300);
  const width = await browser.value('document.documentElement.scrollWidth');
  if (pictures) writeFileSync(join(pictures, 'live_phone.png'), await browser.picture());
  assert.ok(width <= 390, `the page is ${width} px wide on a phone`);
  await browser.resize(1400, 860);
  await browser.scheme('light');
}

let browser;
let run;

/// A run, its page, and nothing felt yet.
async function begin() {
  run = start(palpate, 'run', at('scene.toml'), '--device', 'mouse', '--view', '--no-browser', '--json');
  browser.errors.length = 0;
  await loadPage(browser, run);
  await comesTrue('nothing is rendered', async () => (await textOf(browser, 'state')) === 'rendering');
  assert.equal(await newtons(browser), 0);
  await browser.value('document.getElementById("fit").click()');
  await browser.drawn();
  await checkOverStage(browser);
}

/// The run ends as the page says, and has kept its promises.
async function end() {
  run.child.kill('SIGINT');
  await comesTrue('the end is not said', async () => /has ended/.test(await textOf(browser, 'link')));
  const status = await run.exited;
  assert.ok(status === 0 || status === 5, `exit status ${status}: ${run.err}`);
  const summary = JSON.parse(run.out);
  assert.equal(summary.allocations, 0);
  assert.equal(summary.page_faults, 0);
  assert.ok(summary.force_N.max <= 3);
  return summary;
}

async function driveByMouse() {
  await begin();
  const before = await browser.picture('#stage');
  const tool = await findTool(browser);
  await drag(browser, tool, { x: tool.x + 5, y: tool.y + 120 });
  await comesTrue('no force', async () => (await newtons(browser)) > 0.05);
  await sleep(1500);
  const held = await newtons(browser);
  assert.ok(held > 0.05 && held <= 3, `${held} N`);
  assert.match(await textOf(browser, 'contacts'), /^\d+; (overlap by|least distance) /);
  assert.match(await textOf(browser, 'arrow'), / N$/);
  assert.equal(await browser.value('document.getElementById("arrow").hidden'), false);
  assert.ok(!before.equals(await browser.picture('#stage')), 'the tool does not move');
  for (const id of ['force', 'torque', 'energy', 'time']) {
    assert.ok((await browser.value(`Number(document.getElementById('${id}').dataset.points)`)) > 100, id);
  }
  await checkLooks(browser);
  await browser.mouse('mouseReleased', tool.x + 5, tool.y + 120, { button: 'left' });
  await comesTrue('it goes on pulling', async () => (await newtons(browser)) < 0.2 * held);

  const again = await findTool(browser);
  const turned = await browser.picture('#stage');
  await drag(browser, again, { x: again.x + 60, y: again.y }, { shift: true });
  await browser.mouse('mouseReleased', again.x + 60, again.y, { button: 'left', shift: true });
  await sleep(300);
  assert.ok(!turned.equals(await browser.picture('#stage')), 'the tool does not turn');
  for (let i = 0; i < 10; ++i) {
    await browser.mouse('mouseWheel', again.x, again.y, { deltaY: 200 });
    await sleep(30);
  }
  await comesTrue('the wheel does not take it away', async () => (await newtons(browser)) === 0);
  return end();
}

/// Chromium has no gamepad here: one of this test's stands in for it.
async function driveByPad() {
  await begin();
  const plug = (pads) => browser.value(`navigator.getGamepads = () => ${pads}; dispatchEvent(new Event('gamepadconnected'));`);
  assert.match(await textOf(browser, 'pad'), /^Press one/);
  await plug(`[null, { id: 'odd pad', connected: true, mapping: '', axes: [0, 1], buttons: [] }]`);
  assert.match(await textOf(browser, 'pad'), /^Not used: odd pad/);
  await browser.value(`window.pad = { id: 'test pad', connected: true, mapping: 'standard', axes: [0, 0, 0, 0],
    buttons: Array.from({ length: 17 }, () => ({ value: 0, pressed: false })) };`);
  await plug('[null, window.pad]');
  assert.match(await textOf(browser, 'pad'), /^In use: test pad/);
  await sleep(300);
  assert.equal(await newtons(browser), 0);  // at rest it leads nowhere
  await browser.value('window.pad.axes[1] = 1');  // down
  await comesTrue('the stick pulls nothing', async () => (await newtons(browser)) > 0.05, 400);
  await browser.value('window.pad.axes[1] = 0');
  await sleep(500);
  const held = await newtons(browser);
  assert.ok(held > 0.02, `it does not stay: ${held} N`);
  assert.match(await readContact(browser), /^(overlap|gap) .*, carries/);
  const turned = await browser.picture('#stage');
  await browser.value('window.pad.axes[2] = 1');
  await sleep(500);
  await browser.value('window.pad.axes[2] = 0; window.pad.buttons[0].pressed = true');
  assert.ok(!turned.equals(await browser.picture('#stage')), 'the other stick does not turn the tool');
  await comesTrue('its button does not let go', async () => (await newtons(browser)) < 0.2 * held);
  await plug('[]');
  assert.match(await textOf(browser, 'pad'), /^Press one/);
  return end();
}

/// A machine that is too busy to hold the loop up ends the force with a fault: then it is no test.
async function undisturbed(drive, tries = 3) {
  for (let left = tries; ; --left) {
    let failure = null;
    let faults = [];
    try {
      ({ faults } = await drive());
    } catch (error) {
      failure = error;
      if (/^fault/.test(await textOf(browser, 'state'))) faults = ['seen'];
    } finally {
      run.child.kill('SIGKILL');
    }
    if (faults.length === 0 && !failure) return;
    if (faults.length === 0 || left === 1) throw failure ?? new Error(`faults: ${faults}`);
  }
}

try {
  makeScene();
  browser = await Chromium.open(program);
  await browser.resize(1400, 860);
  await undisturbed(driveByMouse);
  await undisturbed(driveByPad);
  const others = browser.requests.filter((request) => !/^(http|ws):\/\/127\.0\.0\.1:\d+\/[0-9a-f]{32}\/|^data:|^about:/.test(request));
  assert.deepEqual(others, []);
  assert.deepEqual(browser.errors, []);
} finally {
  run?.child.kill('SIGKILL');
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
}
