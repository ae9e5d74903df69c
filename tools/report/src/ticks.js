// SPDX-License-Identifier: GPL-3.0-or-later
// Plots over the ticks of replays and runs: profiles, durations, certificates.
import { kOfRun } from './colours.js';
import { counts, floats } from './data.js';
import { addPlot } from './plot.js';
import { pointGroups } from './trade.js';

const at = (id) => document.getElementById(id);

/// A line keeps its colour from plot to plot.
function lineSeries(lines, key) {
  return lines.map((line, colour) => ({ name: line.name, values: floats(line[key]), kind: 'line', colour }));
}

/// Lines of a run: [name, values] each.
function ofRun(...lines) {
  return lines.map(([name, packed]) => ({ name, values: floats(packed), kind: 'line', colour: kOfRun[name] }));
}

/// What every plot over the time of the recording has.
function overTime(data, playhead) {
  return {
    x: floats(data.frames.t_s),
    xLabel: 'time (s)',
    overTime: true,
    onClick: (index) => playhead.set((index * data.frames.stride) / data.shown.stride),
    marks: data.run?.marks ?? [],
  };
}

function follow(data, playhead, plots) {
  const times = floats(data.shown.t_s);
  const show = (frame) => plots.forEach((plot) => plot.show(times[frame]));
  playhead.onChange(show);
  show(playhead.frame);
}

/// Of a run: what no tick may exceed.
function timeLevels({ run }) {
  if (!run) return [];
  const levels = [{ y: run.period_us, name: 'period' }];
  if (run.budget_us !== null) levels.push({ y: run.budget_us, name: 'budget' });
  return levels;
}

export function showProfiles(data, playhead) {
  at('profiles').hidden = false;
  const common = overTime(data, playhead);
  const force = lineSeries(data.lines, 'force_N');
  if (data.run) {
    force[0].name = 'computed';
    force.push(...ofRun(['sent', data.run.sent_N]));
  }
  follow(data, playhead, [
    addPlot(at('force'), { ...common, title: 'Force', yLabel: 'force (N)', series: force }),
    addPlot(at('time'), {
      ...common,
      title: 'Query time',
      yLabel: 'time (µs)',
      logY: true,
      series: lineSeries(data.lines, 'time_us'),
      levels: timeLevels(data),
    }),
    addPlot(at('front'), { ...common, title: 'Front', yLabel: 'nodes of the front', logY: true, series: lineSeries(data.lines, 'front') }),
    addPlot(at('contacts'), { ...common, title: 'Contacts', yLabel: 'contacts', series: lineSeries(data.lines, 'contacts') }),
  ]);
}

/// What only a run has: what was sent, and what came back.
export function showRun(data, playhead) {
  const { run } = data;
  at('run').hidden = false;
  const common = overTime(data, playhead);
  const axes = (packed) => ofRun(...['x', 'y', 'z'].map((name, i) => [name, packed[i]]));
  follow(data, playhead, [
    addPlot(at('sent'), { ...common, title: 'Force sent', yLabel: 'force (N)', series: axes(run.sent_xyz_N) }),
    addPlot(at('torque'), {
      ...common,
      title: 'Torque',
      yLabel: 'torque (N m)',
      series: ofRun(['computed', run.torque_Nm], ['sent', run.sent_torque_Nm]),
    }),
    addPlot(at('position'), { ...common, title: 'Position of the tool', yLabel: 'moved by (mm)', series: axes(run.moved_xyz_mm) }),
    addPlot(at('energy'), { ...common, title: 'Energy from the hand to the scene', yLabel: 'energy (mJ)', series: ofRun(['energy', run.energy_mJ]) }),
    addPlot(at('age'), { ...common, title: 'Age of readings', yLabel: 'age (µs)', logY: true, series: ofRun(['age', run.age_us]) }),
  ]);
}

export function showLatency(data, playhead) {
  at('latency').hidden = false;
  const { from_us: from, bins_per_octave: perOctave, sets } = data.latency;
  const x = Array.from(floats(from));
  x.push(x[x.length - 1] * 2 ** (1 / perOctave));  // where the last step ends
  const share = (set) => {
    const list = Array.from(counts(set.counts));
    const all = list.reduce((a, b) => a + b, 0);
    return [...list.map((n) => (100 * n) / Math.max(all, 1)), 0];
  };
  addPlot(at('histogram'), {
    title: 'How often',
    x,
    xLabel: 'duration (µs)',
    yLabel: 'share of ticks (%)',
    logX: true,
    logY: true,
    series: sets.map((set, i) => ({ name: set.name, values: share(set), kind: 'steps', width: 2, colour: i < data.lines.length ? i : kOfRun.late })),
  });
  const series = lineSeries(data.lines, 'time_us');
  if (data.late_us) {
    series[0].name = 'tick';
    series.push({ name: 'late wake-up', values: floats(data.late_us), kind: 'line', colour: kOfRun.late });
  }
  follow(data, playhead, [
    addPlot(at('timeline'), {
      ...overTime(data, playhead),
      title: 'When',
      yLabel: 'duration (µs)',
      logY: true,
      series,
      levels: timeLevels(data),
    }),
  ]);
}

/// Points of bound against true error, in millimetres: of settings, or of the ticks of lines.
function scatterSeries(data) {
  const mm = (list) => Array.from(list, (v) => (v === null ? null : 1e3 * v));
  if (data.settings.length > 0) {
    return pointGroups(data.settings.filter((s) => !s.exact), data.lines).map(({ name, members, ...look }) => ({
      name, ...look, x: mm(members.map((s) => s.error_m)), values: mm(members.map((s) => s.bound_m)),
    }));
  }
  return data.lines
    .map((line, colour) => ({ line, colour }))
    .filter(({ line }) => line.error_m)
    .map(({ line, colour }) => ({ name: line.name, kind: 'points', size: 5, colour, x: mm(floats(line.error_m)), values: mm(floats(line.bound_m)) }));
}

/// Where nothing is better than promised, and nothing worse.
function equality(series) {
  const positive = series.flatMap((s) => [...s.x, ...s.values]).filter((v) => v > 0);
  if (positive.length === 0) return [];
  const ends = positive.reduce(([low, high], v) => [Math.min(low, v), Math.max(high, v)], [Infinity, 0]);
  return [{ name: 'bound = error', kind: 'joined', dash: [2, 4], colour: '--quiet', x: ends, values: ends }];
}

export function showCertificate(data, playhead) {
  const points = scatterSeries(data).filter((s) => s.x.some((v, i) => v > 0 && s.values[i] > 0));
  if (points.length === 0 && data.lines.length === 0) return;
  at('certificate').hidden = false;
  at('promise').textContent =
    points.length > 0
      ? 'The true error of the least distance lies below the bound that the tick gave with it: every point is above the dotted line. ' +
        'The nearer to it, the tighter the bound. ' +
        (data.settings.length > 0 ? 'A point is the median of one setting. ' : 'A point is one tick. ') +
        'Where the true error is zero there is no point.'
      : 'Each tick says how far its least distance can be from the truth. There is no exact replay in this report to compare it with.';
  if (points.length > 0) {
    addPlot(at('scatter'), {
      title: 'Bound against true error',
      series: [...points, ...equality(points)],
      xLabel: 'true error (mm)',
      yLabel: 'error bound (mm)',
      logX: true,
      logY: true,
      height: 320,
    });
  }
  if (data.lines.length > 0) {
    follow(data, playhead, [
      addPlot(at('bounds'), {
        ...overTime(data, playhead),
        title: 'Bound of every tick',
        yLabel: 'error bound (mm)',
        logY: true,
        series: data.lines
          .map((line, colour) => ({ line, colour }))
          .filter(({ line }) => !line.exact)
          .map(({ line, colour }) => ({ name: line.name, kind: 'line', colour, values: floats(line.bound_m).map((v) => 1e3 * v) })),
      }),
    ]);
  }
}
