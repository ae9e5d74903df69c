// SPDX-License-Identifier: GPL-3.0-or-later
// Plots over the ticks of replays and runs: profiles, durations, certificates.
import { counts, floats } from './data.js';
import { addPlot } from './plot.js';

const at = (id) => document.getElementById(id);

function lineSeries(lines, key) {
  return lines.map((line) => ({ name: line.name, values: floats(line[key]), kind: 'line' }));
}

export function showProfiles(data, playhead) {
  const { count, stride } = data.frames;
  at('profiles').hidden = false;
  const ticks = Array.from({ length: count }, (_, frame) => frame * stride);
  const common = { x: ticks, xLabel: 'tick', onClick: (index) => playhead.set(index) };
  const plots = [
    addPlot(at('force'), { ...common, title: 'Force', yLabel: 'force (N)', series: lineSeries(data.lines, 'force_N') }),
    addPlot(at('time'), { ...common, title: 'Query time', yLabel: 'time (µs)', logY: true, series: lineSeries(data.lines, 'time_us') }),
    addPlot(at('front'), { ...common, title: 'Front', yLabel: 'nodes of the front', logY: true, series: lineSeries(data.lines, 'front') }),
  ];
  const follow = (frame) => plots.forEach((plot) => plot.show(ticks[frame]));
  playhead.onChange(follow);
  follow(playhead.frame);
}

export function showLatency(data) {
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
    series: sets.map((set) => ({ name: set.name, values: share(set), kind: 'steps', width: 2 })),
  });
  const series = lineSeries(data.lines, 'time_us');
  if (data.late_us) {
    series[0].name = 'tick';
    series.push({ name: 'late wake-up', values: floats(data.late_us), kind: 'line' });
  }
  addPlot(at('timeline'), {
    title: 'When',
    x: floats(data.frames.t_s),
    xLabel: 'time of the recording (s)',
    yLabel: 'duration (µs)',
    logY: true,
    series,
  });
}

/// Points of bound against true error, in millimetres: of settings, or of the ticks of lines.
function scatterSeries(data) {
  const mm = (list) => Array.from(list, (v) => (v === null ? null : 1e3 * v));
  if (data.settings.length > 0) {
    return ['levels', 'regions'].map((engine) => {
      const members = data.settings.filter((s) => s.engine === engine && !s.exact);
      return { name: engine, kind: 'points', x: mm(members.map((s) => s.error_m)), values: mm(members.map((s) => s.bound_m)) };
    });
  }
  return data.lines
    .filter((line) => line.error_m)
    .map((line) => ({ name: line.name, kind: 'points', size: 5, x: mm(floats(line.error_m)), values: mm(floats(line.bound_m)) }));
}

/// Where nothing is better than promised, and nothing worse.
function equality(series) {
  const positive = series.flatMap((s) => [...s.x, ...s.values]).filter((v) => v > 0);
  if (positive.length === 0) return [];
  const ends = positive.reduce(([low, high], v) => [Math.min(low, v), Math.max(high, v)], [Infinity, 0]);
  return [{ name: 'bound = error', kind: 'joined', dash: [2, 4], colour: 6, x: ends, values: ends }];
}

export function showCertificate(data) {
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
    const { count, stride } = data.frames;
    addPlot(at('bounds'), {
      title: 'Bound of every tick',
      x: Array.from({ length: count }, (_, frame) => frame * stride),
      xLabel: 'tick',
      yLabel: 'error bound (mm)',
      logY: true,
      series: data.lines
        .filter((line) => !line.exact)
        .map((line) => ({ name: line.name, kind: 'line', values: floats(line.bound_m).map((v) => 1e3 * v) })),
    });
  }
}
