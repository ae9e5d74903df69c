// SPDX-License-Identifier: GPL-3.0-or-later
// The last seconds of a run, as plots that move on.
import { kOfRun } from './colours.js';
import { kMarks } from './live_data.js';
import { addPlot } from './plot.js';

const kRedrawEvery_ms = 50;

export class Strip {
  #samples = [];
  #plots = [];
  #drawn_ms = 0;

  /// hosts: {force, torque, energy, time}
  constructor(hosts, { seconds, budget_us, rate_Hz }) {
    this.seconds = seconds;
    const add = (host, title, yLabel, names, keys, more = {}) => {
      const series = names.map((name) => ({ name, values: [], kind: 'line', colour: kOfRun[name] }));
      const plot = addPlot(host, {
        title, x: [], series, xLabel: 's', yLabel, height: 118, compact: true, span: () => this.#span(), edgeMarks: () => this.#marks(), ...more,
      });
      this.#plots.push({ plot, keys });
    };
    const period_us = 1e6 / rate_Hz;
    const budget = budget_us === null ? { y: period_us, name: 'period' } : { y: budget_us, name: 'budget' };
    add(hosts.force, 'Force (N)', 'N', ['computed', 'sent'], ['rendered_N', 'sent_N']);
    add(hosts.torque, 'Torque sent (N m)', 'N m', ['sent'], ['sent_Nm']);
    add(hosts.energy, 'Energy from the hand (mJ)', 'mJ', ['energy'], ['energy_mJ']);
    add(hosts.time, 'Tick time (µs)', 'µs', ['tick'], ['tick_us'], { lines: [budget] });
  }

  push(samples) {
    // Another run, or the page was away.
    if (samples.length > 0 && this.#samples.length > 0 && samples[0].t_s < this.#samples.at(-1).t_s) this.#samples = [];
    this.#samples.push(...samples);
    const from = (this.#samples.at(-1)?.t_s ?? 0) - this.seconds;
    const first = this.#samples.findIndex((s) => s.t_s >= from);
    if (first > 0) this.#samples.splice(0, first);
  }

  /// The largest force in sight.
  most_N() {
    return this.#samples.reduce((most, s) => Math.max(most, s.sent_N), 0);
  }

  draw(now_ms, always = false) {
    if (!always && now_ms - this.#drawn_ms < kRedrawEvery_ms) return;
    this.#drawn_ms = now_ms;
    const column = (key) => this.#samples.map((s) => s[key]);
    const x = column('t_s');
    for (const { plot, keys } of this.#plots) plot.setTable([x, ...keys.map(column)]);
  }

  #span() {
    const to = this.#samples.at(-1)?.t_s ?? 0;
    return [to - this.seconds, to];
  }

  #marks() {
    const colour = (marks) => ((marks & kMarks.fault) !== 0 ? '--overlap' : (marks & kMarks.missed) !== 0 ? '--series-4' : null);
    return this.#samples.filter((s) => colour(s.marks)).map((s) => ({ x: s.t_s, colour: colour(s.marks) }));
  }
}
