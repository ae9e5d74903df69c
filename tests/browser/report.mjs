// SPDX-License-Identifier: GPL-3.0-or-later
// Reports in headless Chromium: node report.mjs CHROMIUM PALPATE SWEEP.json
// Each loads from disk, asks for nothing else, shows data in every plot, moves the bodies with the
// slider, says no error, and does so in light and dark and on a phone.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdtempSync, mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { Chromium } from './chromium.mjs';
import { checkOverStage, readContact } from './over_stage.mjs';

const [program, palpate, sweep] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), 'palpate-report-'));
const at = (...names) => join(folder, ...names);
const run = (...args) => execFileSync(palpate, args, { stdio: ['ignore', 'ignore', 'inherit'] });

const kTicks = 60;
const kScene = `
[engine]
delta_m = DELTA
[force]
stiffness_N_per_m = 50.0
[[body]]
name = "tool"
image = "ball.palp"
role = "tool"
position = [0.0, 0.0, HIGH]
[[body]]
name = "table"
image = "ball.palp"
[[mock.path]]
t_s = 0.0
position = [0.0, 0.0, HIGH]
[[mock.path]]
t_s = 0.2
position = [0.0, 0.0, LOW]
`;

const sceneOf = (radius) =>
  kScene
    .replaceAll('ball.palp', at('ball.palp'))
    .replaceAll('DELTA', 0.05 * radius)
    .replaceAll('HIGH', 2.06 * radius)
    .replaceAll('LOW', 1.9 * radius);

/// The tool comes down until both overlap, and half of the way up again.
function poses(radius) {
  const rows = ['t,body,px,py,pz,qw,qx,qy,qz'];
  for (let i = 0; i < kTicks; ++i) {
    const z = radius * (2.06 - 0.12 * Math.sin((0.8 * Math.PI * i) / (kTicks - 1)));  // they touch at 2
    rows.push(`${i / 1000},tool,0,0,${z},1,0,0,0`);
  }
  return `${rows.join('\n')}\n`;
}

function makeData() {
  run('make-model', 'golf_ball', '-o', at('ball.ply'), '--triangles', '2000');
  run('bake', at('ball.ply'), '-o', at('ball.palp'), '--quiet');
  const radius = JSON.parse(execFileSync(palpate, ['inspect', at('ball.palp'), '--json'])).radius_m;
  mkdirSync(at('replay'));
  for (const place of ['.', 'replay']) {
    writeFileSync(at(place, 'scene.toml'), sceneOf(radius));
    writeFileSync(at(place, 'poses.csv'), poses(radius));
  }
  const replay = (name, ...more) =>
    run('replay', at('scene.toml'), '--poses', at('poses.csv'), '-o', at('replay', `${name}.csv`), '--quiet', ...more);
  replay('exact', '--exact');
  replay('coarse', '--s0', '1', '--contacts', at('replay', 'coarse_contacts.csv'));
  copyFileSync(at('replay', 'coarse.csv'), at('replay', '<img src=x onerror=alert(1)>.csv'));

  mkdirSync(at('sweep', 'ticks'), { recursive: true });
  copyFileSync(sweep, at('sweep', 'sweep.json'));
  copyFileSync(at('replay', 'exact.csv'), at('sweep', 'ticks', 'levels-exact.csv'));
  copyFileSync(at('replay', 'coarse.csv'), at('sweep', 'ticks', 'levels-s0_0.05.csv'));
  writeFileSync(at('sweep', 'about.json'), JSON.stringify({ scene: at('scene.toml'), poses: at('poses.csv') }));

  try {
    run('run', at('scene.toml'), '--seconds', '0.5', '-o', at('run.trace'));
  } catch (error) {
    assert.equal(error.status, 5);  // a busy machine missed deadlines: the trace is whole
  }
}

async function checkPlots(browser, ids) {
  for (const id of ids) {
    const points = await browser.value(`Number(document.querySelector('${id}').dataset.points)`);
    assert.ok(points > 1, `${id} has ${points} points`);
    assert.ok(await browser.value(`document.querySelector('${id} canvas').width > 200`), `${id} has no canvas`);
  }
}

async function checkSlider(browser) {
  const reading = () => browser.value('document.getElementById("reading").textContent');
  await browser.value('document.getElementById("frame").focus()');
  await browser.press('Home');
  const shown = async () => ({ text: await reading(), picture: await browser.picture('#stage') });
  const first = await shown();
  assert.match(first.text, /^Tick 0,/);
  for (let i = 0; i < 20; ++i) await browser.press('ArrowRight');
  assert.match(await reading(), /^Tick 20,/);
  await browser.press('End');
  const last = await shown();
  const height = ({ text }) => Number(text.match(/moved by \((.*), (.*), (.*)\) mm/)[3]);
  assert.notEqual(height(first), height(last));
  assert.ok(!first.picture.equals(last.picture), 'the bodies do not move');
  const lines = await browser.value('[...document.querySelectorAll("#profiles .now")].map((mark) => mark.style.left)');
  assert.equal(new Set(lines).size, 1);
}

/// A drag over one plot zooms all plots over time, and a double click shows all of it again.
async function checkZoom(browser) {
  const ends = () => browser.value('[...document.querySelectorAll("[data-from]")].map((plot) => `${plot.dataset.from} ${plot.dataset.to}`)');
  const before = new Set(await ends());
  assert.equal(before.size, 1, 'plots over time show different stretches');
  await browser.value('document.getElementById("force").scrollIntoView()');
  const box = await browser.value('(({ left, top, width, height }) => ({ left, top, width, height }))(document.querySelector("#force .u-over").getBoundingClientRect())');
  const middle = box.top + box.height / 2;
  await browser.drag([box.left + 0.3 * box.width, middle], [box.left + 0.6 * box.width, middle]);
  const zoomed = new Set(await ends());
  assert.equal(zoomed.size, 1, 'zoom is not shared');
  assert.ok(!before.has([...zoomed][0]), 'a drag does not zoom');
  await browser.value('document.querySelector("#force .u-over").dispatchEvent(new MouseEvent("dblclick", { bubbles: true }))');
  assert.deepEqual(new Set(await ends()), before);
}

/// It plays in real time, or as much slower as one asks.
async function checkPlay(browser) {
  const frame = () => browser.value('document.getElementById("frame").valueAsNumber');
  await browser.value('document.getElementById("frame").focus()');
  await browser.press('Home');
  await browser.value(`document.getElementById('speed').value = '0.05'; document.getElementById('play').click()`);
  await new Promise((done) => setTimeout(done, 600));
  await browser.value(`document.getElementById('play').click()`);
  const shown = await frame();
  const step_s = await browser.value('Number(document.querySelector("[data-to]").dataset.to)') / (await browser.value('Number(document.getElementById("frame").max)'));
  assert.ok(shown * step_s > 0.01 && shown * step_s < 0.06, `after 0.6 s at a twentieth it shows ${shown * step_s} s`);
  await browser.value(`document.getElementById('speed').value = '1'`);
}

/// What has one name has one colour, whichever plot it is in.
async function checkColours(browser) {
  const said = await browser.value('[...document.querySelectorAll("[data-colours]")].flatMap((plot) => plot.dataset.colours.split("; "))');
  const colours = new Map();
  for (const [name, colour] of said.filter((line) => line !== '').map((line) => line.split(/: (?=[^:]*$)/))) {
    assert.equal(colours.get(name) ?? colour, colour, name);
    colours.set(name, colour);
  }
  assert.ok(colours.size > 1);
}

/// The arrow says its force at the frame that is felt most, and a contact says what it is.
async function checkStage(browser) {
  await checkOverStage(browser);
  assert.match(await browser.value('document.getElementById("arrow").textContent'), /^[\d.e-]+ N$/);
  assert.equal(await browser.value('document.getElementById("arrow").hidden'), false);
  assert.match(await readContact(browser), /^(overlap|gap) [^\n]*, carries [^\n]*\ntool at level \d+, table at level \d+$/);
}

/// A click on a title sorts by it, a second one the other way; what has no figure stays last.
async function checkTable(browser) {
  const column = (title) =>
    browser.value(`(() => {
      const heads = [...document.querySelectorAll('#settings th')];
      const i = heads.findIndex((head) => head.textContent === '${title}');
      heads[i].querySelector('button').click();
      return [...document.querySelectorAll('#settings tbody tr')].map((row) => row.cells[i].textContent);
    })()`);
  const up = await column('Front');
  const down = await column('Front');
  const figures = (cells) => cells.filter((cell) => cell !== '–').map((cell) => Number(cell.replaceAll(',', '')));
  assert.ok(figures(up).length > 2);
  assert.deepEqual(figures(up), figures(up).toSorted((a, b) => a - b));
  assert.deepEqual(figures(down), figures(up).toReversed());
}

async function checkLooks(browser, name) {
  const paper = () => browser.value('getComputedStyle(document.body).backgroundColor');
  await browser.scheme('light');
  const light = { paper: await paper(), picture: await browser.picture() };
  await browser.scheme('dark');
  const dark = { paper: await paper(), picture: await browser.picture() };
  assert.notEqual(light.paper, dark.paper, name);
  assert.ok(!light.picture.equals(dark.picture), name);
  await browser.resize(390, 800);
  const width = await browser.value('document.documentElement.scrollWidth');
  assert.ok(width <= 390, `${name} is ${width} px wide on a phone`);
  await browser.resize(1200, 900);
  await browser.scheme('light');
}

async function checkReport(browser, source, plots, sections) {
  const page = at(`report-${source}.html`);
  run('report', at(source), '-o', page, '--quiet');
  const url = pathToFileURL(page).href;
  browser.requests.length = 0;
  await browser.load(url);
  const shown = await browser.value('[...document.querySelectorAll("section:not([hidden])")].map((section) => section.id)');
  assert.deepEqual(shown, sections, source);
  await checkPlots(browser, plots);
  await checkStage(browser);
  await checkColours(browser);
  await checkSlider(browser);
  await checkPlay(browser);
  await checkZoom(browser);
  if (plots.includes('#trade .plot')) await checkTable(browser);
  await checkLooks(browser, source);
  assert.ok((await browser.value('document.querySelectorAll("#words li").length')) > 1);
  assert.equal(await browser.value('document.querySelectorAll("img").length'), 0, 'a name became markup');
  assert.deepEqual(browser.requests.filter((request) => request !== url && !request.startsWith('data:')), []);
  assert.deepEqual(browser.errors, [], source);
}

let browser;
try {
  makeData();
  browser = await Chromium.open(program);
  await browser.resize(1200, 900);
  const perTick = ['#force', '#time', '#front', '#contacts', '#histogram', '#timeline', '#bounds'];
  const sections = ['view', 'profiles', 'latency', 'certificate'];
  const ofRun = ['#sent', '#torque', '#position', '#energy', '#age'];
  await checkReport(browser, 'replay', [...perTick, '#scatter'], ['summary', ...sections]);
  await checkReport(browser, 'sweep', ['#trade .plot', ...perTick, '#scatter'], ['summary', 'trade', ...sections]);
  const runSections = ['summary', 'view', 'profiles', 'run', 'latency', 'certificate'];
  await checkReport(browser, 'run.trace', ['#time', '#histogram', '#timeline', '#bounds', ...ofRun], runSections);
} finally {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
}
