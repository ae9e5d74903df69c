// SPDX-License-Identifier: GPL-3.0-or-later
// Error against time, a point a setting.
import { colourOfSetting } from './colours.js';
import { addPlot } from './plot.js';
import { duration, millimetres, number, percent } from './units.js';

const nameOf = (s) => `${s.engine}: ${s.words}`;

function describe(s) {
  return (
    `${nameOf(s)}. Median ${duration(s.median_us)}, p99.9 ${duration(s.p999_us)}; error of the force ${percent(s.force_nrmse)}, ` +
    `of the torque ${percent(s.torque_nrmse)}; noticeable in ${percent(s.noticeable)} of the ticks; cut short in ${percent(s.truncated)}.`
  );
}

/// Settings as points: what has a line in the profiles in its colour; the others of each engine together, in grey beside those.
export function pointGroups(settings, lines) {
  const out = new Map();
  for (const s of settings) {
    const own = colourOfSetting(s, lines);
    const name = [s.engine, ...(own === null ? [] : [s.words]), ...(s.exact ? ['exact'] : [])].join(', ');
    if (!out.has(name)) {
      const colour = own ?? (lines.length > 0 ? ['--quiet', '--ink'] : [0, 1])[Number(s.engine !== 'levels')];
      out.set(name, { name, kind: 'points', colour, size: own === null ? 7 : 10, hollow: s.exact, members: [] });
    }
    out.get(name).members.push(s);
  }
  return [...out.values()];
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

/// Title, what it sorts by, and how that is written.
const columns = [
  ['Engine', (s) => s.engine],
  ['Setting', (s) => s.words],
  ['Median', (s) => s.median_us, duration],
  ['p99', (s) => s.p99_us, duration],
  ['p99.9', (s) => s.p999_us, duration],
  ['Largest', (s) => s.max_us, duration],
  ['Times as fast', (s) => s.speedup, number],
  ['Front', (s) => s.front_mean, number],
  ['Queries', (s) => s.queries_mean, number],
  ['Cut short', (s) => s.truncated, percent],
  ['Error of force', (s) => s.force_nrmse, percent],
  ['Error of torque', (s) => s.torque_nrmse, percent],
  ['Noticeable', (s) => s.noticeable, percent],
  ['Error bound', (s) => s.bound_m, millimetres],
  ['True error', (s) => s.error_m, millimetres],
];

/// Least first; what there is no figure for comes last, whichever way it is sorted.
function order(value, down) {
  return (a, b) => {
    const [x, y] = [value(a), value(b)];
    if (x === null || y === null) return (x === null) - (y === null);
    const less = typeof x === 'string' ? x.localeCompare(y, 'en', { numeric: true }) : x - y;
    return down ? -less : less;
  };
}

/// A click on a title sorts by it, a second one the other way round.
function fillTable(table, settings, lines) {
  const head = table.createTHead().insertRow();
  const body = table.createTBody();
  const sort = (column, down) => {
    [...head.cells].forEach((cell, i) => {
      if (i === column) cell.setAttribute('aria-sort', down ? 'descending' : 'ascending');
      else cell.removeAttribute('aria-sort');
    });
    body.replaceChildren();
    for (const s of [...settings].sort(order(columns[column][1], down))) {
      const row = body.insertRow();
      row.className = s.pareto ? 'best' : '';
      for (const [, value, text] of columns) row.insertCell().textContent = text ? text(value(s)) : value(s);
      const own = colourOfSetting(s, lines);
      if (own === null) continue;
      const chip = document.createElement('i');
      chip.style.background = `var(--series-${own})`;
      row.cells[1].append(chip);
    }
  };
  columns.forEach(([title], column) => {
    const cell = document.createElement('th');
    cell.scope = 'col';
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = title;
    button.addEventListener('click', () => sort(column, cell.getAttribute('aria-sort') === 'ascending'));
    cell.append(button);
    head.append(cell);
  });
  sort(2, false);
}

export function showTrade(section, settings, lines) {
  section.hidden = false;  // first: a plot is as wide as its place
  const series = [];
  for (const { members, ...look } of pointGroups(settings, lines)) {
    series.push({ ...look, x: members.map((s) => s.median_us), values: members.map((s) => 100 * s.drawn_nrmse) });
  }
  for (const [delta, members] of fronts(settings)) {
    series.push({
      name: `best trades, delta ${millimetres(delta)}`,
      kind: 'joined',
      dash: [6, 4],
      colour: '--quiet',
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
  fillTable(document.getElementById('settings'), settings, lines);
}
