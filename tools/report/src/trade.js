// SPDX-License-Identifier: GPL-3.0-or-later
// Error against time, a point a setting.
import { addPlot } from './plot.js';
import { duration, millimetres, number, percent } from './units.js';

const nameOf = (s) => `${s.engine}: ${s.words}`;

function describe(s) {
  return (
    `${nameOf(s)}. Median ${duration(s.median_us)}, p99.9 ${duration(s.p999_us)}; error of the force ${percent(s.force_nrmse)}, ` +
    `of the torque ${percent(s.torque_nrmse)}; noticeable in ${percent(s.noticeable)} of the ticks; cut short in ${percent(s.truncated)}.`
  );
}

function groups(settings) {
  const out = new Map();
  for (const s of settings) {
    const name = s.exact ? `${s.engine}, exact` : s.engine;
    if (!out.has(name)) out.set(name, []);
    out.get(name).push(s);
  }
  return out;
}

/// The best trades of each delta: settings of different deltas do not compete.
function fronts(settings) {
  const out = new Map();
  for (const s of settings.filter((each) => each.pareto)) {
    if (!out.has(s.delta_m)) out.set(s.delta_m, []);
    out.get(s.delta_m).push(s);
  }
  return out;
}

const columns = [
  ['Engine', (s) => s.engine],
  ['Setting', (s) => s.words],
  ['Median', (s) => duration(s.median_us)],
  ['p99', (s) => duration(s.p99_us)],
  ['p99.9', (s) => duration(s.p999_us)],
  ['Largest', (s) => duration(s.max_us)],
  ['Times as fast', (s) => number(s.speedup)],
  ['Front', (s) => number(s.front_mean)],
  ['Queries', (s) => number(s.queries_mean)],
  ['Cut short', (s) => percent(s.truncated)],
  ['Error of force', (s) => percent(s.force_nrmse)],
  ['Error of torque', (s) => percent(s.torque_nrmse)],
  ['Noticeable', (s) => percent(s.noticeable)],
  ['Error bound', (s) => millimetres(s.bound_m)],
  ['True error', (s) => millimetres(s.error_m)],
];

function fillTable(table, settings) {
  const head = table.createTHead().insertRow();
  for (const [title] of columns) {
    const cell = document.createElement('th');
    cell.scope = 'col';
    cell.textContent = title;
    head.append(cell);
  }
  const body = table.createTBody();
  for (const s of [...settings].sort((a, b) => a.median_us - b.median_us)) {
    const row = body.insertRow();
    row.className = s.pareto ? 'best' : '';
    for (const [, text] of columns) row.insertCell().textContent = text(s);
  }
}

export function showTrade(section, settings) {
  section.hidden = false;  // first: a plot is as wide as its place
  const series = [];
  for (const [name, members] of groups(settings)) {
    series.push({
      name,
      kind: 'points',
      colour: members[0].engine === 'levels' ? 0 : 1,
      hollow: members[0].exact,
      x: members.map((s) => s.median_us),
      values: members.map((s) => 100 * s.drawn_nrmse),
    });
  }
  for (const [delta, members] of fronts(settings)) {
    series.push({
      name: `best trades, delta ${millimetres(delta)}`,
      kind: 'joined',
      dash: [6, 4],
      colour: 6,
      x: members.map((s) => s.median_us),
      values: members.map((s) => 100 * s.drawn_nrmse),
    });
  }
  const reading = document.getElementById('setting');
  const nearest = (u) => {
    const { left, top } = u.cursor;
    if (left === undefined || left < 0) return;
    const away = (s) => Math.hypot(u.valToPos(s.median_us, 'x') - left, u.valToPos(100 * s.drawn_nrmse, 'y') - top);
    const timed = settings.filter((s) => s.median_us !== null && s.drawn_nrmse !== null);
    const best = timed.reduce((a, b) => (away(b) < away(a) ? b : a));
    reading.textContent = describe(best);
  };
  addPlot(section.querySelector('.plot'), {
    title: 'Error of the force against time',
    series,
    xLabel: 'time of a tick, median (µs)',
    yLabel: 'error of the force (%)',
    logX: true,
    logY: true,
    height: 380,
    onPoint: nearest,
  });
  fillTable(document.getElementById('settings'), settings);
}
