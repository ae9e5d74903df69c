// SPDX-License-Identifier: GPL-3.0-or-later
// Drives a headless Chromium through its debugging pipe (Chrome DevTools Protocol), without a package.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const flags = [
  '--headless', '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--disable-dev-shm-usage', '--hide-scrollbars',
  // WebGL without a graphics processor.
  '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
  '--remote-debugging-pipe',
];

export class Chromium {
  #waiting = new Map();
  #next = 1;
  #rest = '';
  /// Console messages and exceptions of the page that are errors.
  errors = [];
  /// Addresses that the page asked for.
  requests = [];
  #onLoad = () => {};

  /// @param program  path of the browser
  static async open(program) {
    const browser = new Chromium();
    await browser.#start(program);
    return browser;
  }

  async #start(program) {
    this.profile = mkdtempSync(join(tmpdir(), 'palpate-browser-'));
    this.process = spawn(program, [...flags, `--user-data-dir=${this.profile}`], {
      stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'],
    });
    this.process.stdio[4].setEncoding('utf8').on('data', (text) => this.#receive(text));
    this.exited = new Promise((resolve) => this.process.on('exit', resolve));
    const { targetId } = await this.send('Target.createTarget', { url: 'about:blank' });
    ({ sessionId: this.session } = await this.send('Target.attachToTarget', { targetId, flatten: true }));
    for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await this.send(`${domain}.enable`);
  }

  #receive(text) {
    const messages = (this.#rest + text).split('\0');
    this.#rest = messages.pop();
    for (const message of messages) this.#handle(JSON.parse(message));
  }

  #handle({ id, result, error, method, params }) {
    if (id) {
      const { resolve, reject } = this.#waiting.get(id);
      this.#waiting.delete(id);
      error ? reject(new Error(error.message)) : resolve(result);
    } else if (method === 'Page.loadEventFired') {
      this.#onLoad();
    } else if (method === 'Runtime.exceptionThrown') {
      this.errors.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    } else if (method === 'Runtime.consoleAPICalled' && params.type === 'error') {
      this.errors.push(params.args.map((arg) => arg.value ?? arg.description).join(' '));
    } else if (method === 'Log.entryAdded' && params.entry.level === 'error') {
      this.errors.push(params.entry.text);
    } else if (method === 'Network.requestWillBeSent') {
      this.requests.push(params.request.url);
    }
  }

  send(method, params = {}) {
    const id = this.#next++;
    const session = this.session && !method.startsWith('Target.') ? { sessionId: this.session } : {};
    this.process.stdio[3].write(`${JSON.stringify({ id, method, params, ...session })}\0`);
    return new Promise((resolve, reject) => this.#waiting.set(id, { resolve, reject }));
  }

  async load(url) {
    const loaded = new Promise((resolve) => (this.#onLoad = resolve));
    await this.send('Page.navigate', { url });
    await loaded;
    await this.drawn();
  }

  /// What an expression of the page gives.
  async value(expression) {
    const { result, exceptionDetails } = await this.send('Runtime.evaluate', { expression, returnByValue: true, awaitPromise: true });
    if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.exception?.description}`);
    return result.value;
  }

  /// Once the page has drawn what it was told before.
  drawn() {
    return this.value('new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))');
  }

  async press(key) {
    for (const type of ['keyDown', 'keyUp']) await this.send('Input.dispatchKeyEvent', { type, key, code: key, windowsVirtualKeyCode: { ArrowRight: 39, ArrowLeft: 37, Home: 36, End: 35 }[key] });
    await this.drawn();
  }

  /// type: 'mousePressed', 'mouseMoved', 'mouseReleased' or 'mouseWheel'.
  async mouse(type, x, y, { button = 'none', shift = false, deltaY } = {}) {
    const buttons = { none: 0, left: 1, right: 2 }[type === 'mouseReleased' ? 'none' : button];
    const wheel = deltaY === undefined ? {} : { deltaX: 0, deltaY };
    await this.send('Input.dispatchMouseEvent', { type, x, y, button, buttons, modifiers: shift ? 8 : 0, clickCount: 1, ...wheel });
  }

  /// The left button goes down at one place of the window and up at another.
  async drag([fromX, fromY], [toX, toY]) {
    const mouse = (type, x, y, buttons) => this.send('Input.dispatchMouseEvent', { type, x, y, button: 'left', buttons, clickCount: 1 });
    await mouse('mouseMoved', fromX, fromY, 0);
    await mouse('mousePressed', fromX, fromY, 1);
    for (let i = 1; i <= 4; ++i) await mouse('mouseMoved', fromX + ((toX - fromX) * i) / 4, fromY + ((toY - fromY) * i) / 4, 1);
    await mouse('mouseReleased', toX, toY, 0);
    await this.drawn();
  }

  async resize(width, height) {
    await this.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: width < 600 });
    await this.drawn();
  }

  async scheme(name) {
    await this.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: name }] });
    await this.drawn();
  }

  /// PNG of what a selector names, or of the whole page.
  async picture(selector = 'body') {
    const clip = await this.value(
      `(() => { const r = document.querySelector(${JSON.stringify(selector)}).getBoundingClientRect();` +
        ' return { x: r.x + scrollX, y: r.y + scrollY, width: r.width, height: r.height, scale: 1 }; })()',
    );
    const { data } = await this.send('Page.captureScreenshot', { format: 'png', clip, captureBeyondViewport: true });
    return Buffer.from(data, 'base64');
  }

  async close() {
    await Promise.race([this.send('Browser.close'), this.exited]);
    await this.exited;
    // Its children write for a moment longer.
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 20, retryDelay: 200 });
  }
}
