// SPDX-License-Identifier: GPL-3.0-or-later
// A run with its live page, and a mouse in it.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';

export const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

export async function comesTrue(what, condition, tries = 100) {
  for (let i = 0; i < tries; ++i) {
    if (await condition()) return;
    await sleep(100);
  }
  assert.fail(what);
}

/// A command, and what it says.
export function start(palpate, ...args) {
  const child = spawn(palpate, args, { stdio: ['ignore', 'pipe', 'pipe'] });
  const run = { child, out: '', err: '' };
  child.stdout.setEncoding('utf8').on('data', (text) => (run.out += text));
  child.stderr.setEncoding('utf8').on('data', (text) => (run.err += text));
  run.exited = new Promise((done) => child.on('exit', done));
  return run;
}

/// Loads the page that a run says, once it is live.
export async function loadPage(browser, run, tries = 100) {
  const said = () => run.err.match(/Live view: (\S+)\n/)?.[1];
  await comesTrue('no address', () => said() !== undefined, tries);
  await browser.load(said());
  await comesTrue('the page does not go live', async () => (await textOf(browser, 'link')) === 'live');
}

export const textOf = (browser, id) => browser.value(`document.getElementById('${id}').textContent`);
export const newtons = async (browser) => Number((await textOf(browser, 'wrench')).match(/^([\d.e-]+) N/)?.[1] ?? NaN);

/// A place on the tool: where the page offers to grab it, from the middle of the view outwards.
export async function findTool(browser) {
  const box = await browser.value('(({ x, y, width, height }) => ({ x, y, width, height }))(document.getElementById("stage").getBoundingClientRect())');
  for (let ring = 0; ring < 0.45; ring += 0.04) {
    for (let i = 0; i < 12; ++i) {
      const x = box.x + box.width * (0.5 + ring * Math.sin((Math.PI * i) / 6));
      const y = box.y + box.height * (0.5 - ring * Math.cos((Math.PI * i) / 6));
      await browser.mouse('mouseMoved', x, y);
      if ((await browser.value('document.getElementById("stage").style.cursor')) === 'grab') return { x, y };
    }
  }
  return assert.fail('the tool is nowhere');
}

export async function drag(browser, from, to, options) {
  await browser.mouse('mousePressed', from.x, from.y, { button: 'left', ...options });
  for (let i = 1; i <= 10; ++i) {
    await browser.mouse('mouseMoved', from.x + (i * (to.x - from.x)) / 10, from.y + (i * (to.y - from.y)) / 10, { button: 'left', ...options });
    await sleep(30);
  }
}
