// SPDX-License-Identifier: GPL-3.0-or-later
// Plots with uPlot: line plots over frames, and scatter plots. Colours are the style sheet's.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { number } from './units.js';

const kMarkOfHeight = 0.16;
const rebuilds = [];
/// Plots over the time of the recording: one zoom and one cursor for all of them.
const linked = [];
const kSync = uPlot.sync('time');
const passed = (type) => type === 'mousemove' || type === 'mouseleave';

/// All show the stretch of time that one of them was told to.
function zoomAlike(source) {
  const { min, max } = source.scales.x;
  for (const { plot } of linked) {
    if (plot === source || !plot || (plot.scales.x.min === min && plot.scales.x.max === max)) continue;
    plot.setScale('x', { min, max });
  }
}

/// A level that values stay below, with its name at the right end.
function drawLevel(u, { y, name }) {
  const { ctx, bbox } = u;
  const top = u.valToPos(y, 'y', true);
  if (!(top >= bbox.top && top <= bbox.top + bbox.height)) return;
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = style('--quiet');
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([6 * devicePixelRatio, 4 * devicePixelRatio]);
  ctx.beginPath();
  ctx.moveTo(bbox.left, top);
  ctx.lineTo(bbox.left + bbox.width, top);
  ctx.stroke();
  ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
  ctx.textAlign = 'right';
  ctx.fillText(name, bbox.left + bbox.width - 4, top - 4 * devicePixelRatio);
  ctx.restore();
}

/// Moments: a tick at the lower edge for a missed deadline, a whole line with its name for a fault.
function drawMarks(u, marks) {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = style('--overlap');
  ctx.lineWidth = devicePixelRatio;
  ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
  for (const { t_s: t, fault } of marks) {
    const left = u.valToPos(t, 'x', true);
    if (!(left >= bbox.left && left <= bbox.left + bbox.width)) continue;
    ctx.beginPath();
    ctx.moveTo(left, bbox.top + bbox.height);
    ctx.lineTo(left, fault ? bbox.top : bbox.top + bbox.height - 10 * devicePixelRatio);
    ctx.stroke();
    if (fault) ctx.fillText(fault, left + 3, bbox.top + 11 * devicePixelRatio);
  }
  ctx.restore();
}
const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
/// A place in the style sheet's series, or the name of a colour of its own.
const colourOf = (colour) => style(typeof colour === 'string' ? colour : `--series-${colour % 8}`);

matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  for (const rebuild of rebuilds) rebuild();
});

/// Of a logarithmic axis's places those that can have a name without running into each other: 1, 2
/// and 5 of each power of ten, or over more than two and a half powers the 1 alone.
function named(splits) {
  const shown = splits.filter((v) => v !== null && v > 0);
  const leading = Math.max(...shown) > 300 * Math.min(...shown) ? [1] : [1, 2, 5];
  const digit = (v) => Math.round(v / 10 ** Math.floor(Math.log10(v) + 1e-9));
  return splits.map((v) => (v !== null && leading.includes(digit(v)) ? v : null));
}

function axis(label, log, size) {
  const line = { stroke: () => style('--line'), width: 1 };
  const filter = log ? { filter: (_, splits) => named(splits) } : {};
  return {
    label,
    stroke: () => style('--quiet'),
    grid: { ...line, ...filter },
    ticks: { ...line, ...filter, size: 5 },
    ...filter,
    font: '12px system-ui, sans-serif',
    labelFont: '13px system-ui, sans-serif',
    labelSize: 20,
    size,
    values: (_, splits) => splits.map((v) => (v === null ? '' : number(v))),
  };
}

/// Gaps are null; a logarithmic axis has no place for zero either.
const values = (list, log) => Array.from(list, (v) => (Number.isFinite(v) && !(log && v <= 0) ? v : null));

function seriesOptions(series, index) {
  const colour = () => colourOf(series.colour ?? index);
  const points = series.kind === 'points';
  return {
    label: series.name,
    stroke: colour,
    width: series.width ?? 1.5,
    dash: series.dash,
    spanGaps: series.kind === 'joined',
    paths: points ? () => null : series.kind === 'steps' ? uPlot.paths.stepped({ align: 1 }) : undefined,
    points: { show: points, size: series.size ?? 9, width: 2, fill: series.hollow ? () => style('--card') : colour },
    value: (_, v) => number(v),
  };
}

/// One table of x for all: points of different series seldom share theirs.
function joined(series, logX, logY) {
  return uPlot.join(
    series.map((s) => {
      const order = values(s.x, logX)
        .map((x, i) => [x, i])
        .filter(([x]) => x !== null)
        .sort((a, b) => a[0] - b[0]);
      const y = values(s.values, logY);
      // Two points of a series at one place would be one.
      for (let i = 1; i < order.length; ++i) {
        if (order[i][0] <= order[i - 1][0]) order[i][0] = order[i - 1][0] * (1 + 1e-9);
      }
      return [order.map(([x]) => x), order.map(([, i]) => y[i])];
    }),
  );
}

function drawLines(u, lines) {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = style('--quiet');
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([6 * devicePixelRatio, 4 * devicePixelRatio]);
  ctx.textAlign = 'left';
  ctx.textBaseline = 'alphabetic';
  ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
  for (const { y, name } of lines) {
    const at = u.valToPos(y, 'y', true);
    ctx.beginPath();
    ctx.moveTo(bbox.left, at);
    ctx.lineTo(bbox.left + bbox.width, at);
    ctx.stroke();
    ctx.fillText(name, bbox.left + 4 * devicePixelRatio, at - 3 * devicePixelRatio);
  }
  ctx.restore();
}

/// In the upper margin of what they concern, and not across it.
function drawEdgeMarks(u, marks) {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.lineWidth = 1.5 * devicePixelRatio;
  for (const { x, colour } of marks) {
    const at = u.valToPos(x, 'x', true);
    if (at < bbox.left || at > bbox.left + bbox.width) continue;
    ctx.strokeStyle = style(colour);
    ctx.beginPath();
    ctx.moveTo(at, bbox.top);
    ctx.lineTo(at, bbox.top + kMarkOfHeight * bbox.height);
    ctx.stroke();
  }
  ctx.restore();
}

/// Adds a plot to `host`.
/// series: [{name, values, x?, kind: 'line' | 'joined' | 'points' | 'steps', colour?, hollow?, size?, dash?, width?}]; with `x` of
/// their own, or all over the common x.
/// overTime: x is the time of the recording, and the plot is linked with the others over it.
/// levels: [{y, name}], marks: [{t_s, fault}]: drawn over it.
/// lines: [{y, name}], across the plot and always in sight; edgeMarks: () => [{x, colour}], at the upper edge.
/// compact: no names of axes or values. span: () => [from, to] of x; absent: all of it.
/// Returns {show(x)}: moves the line that marks the page's frame; {setTable([x, ...values])}: other data of the same series.
export function addPlot(
  host,
  {
    title, x, series, xLabel, yLabel, logX, logY, height = 240, onClick, onPoint, overTime, levels = [], marks = [],
    lines = [], edgeMarks, compact, span,
  },
) {
  const heading = document.createElement('h3');
  heading.textContent = title;
  const place = document.createElement('div');
  host.append(heading, place);
  host.dataset.colours = series.map((s, i) => `${s.name}: ${s.colour ?? i}`).join('; ');
  host.dataset.points = 0;
  let table = x ? [values(x, logX), ...series.map((s) => values(s.values, logY))] : joined(series, logX, logY);
  const filled = table.slice(1).flat().filter((v) => v !== null && v !== undefined).length;
  host.dataset.points = filled;
  const mark = document.createElement('div');
  mark.className = 'now';
  mark.hidden = true;
  let plot;
  let shown = null;
  const link = { plot };
  if (overTime) linked.push(link);

  const moveMark = () => {
    mark.hidden = shown === null;
    if (shown !== null) mark.style.left = `${plot.valToPos(shown, 'x')}px`;
  };
  const scale = (log) => (log ? { distr: 3 } : {});
  const yRange = (_, low, high) => {
    const most = Math.max(high ?? 0, ...lines.map((line) => line.y));
    const least = Math.min(low ?? 0, 0);
    return most > least ? [least, most + 0.2 * (most - least)] : [0, 1];
  };
  const yScale = () => (lines.length > 0 || compact ? { range: yRange } : scale(logY));
  const xScale = () => (span ? { range: () => span() } : {});
  const build = () => {
    plot?.destroy();
    plot = link.plot = undefined;
    plot = new uPlot(
      {
        width: Math.max(260, place.clientWidth),
        height,
        scales: { x: { time: false, ...scale(logX), ...xScale() }, y: yScale() },
        axes: compact
          ? [{ ...axis(xLabel, logX, 24), label: undefined }, { ...axis(yLabel, logY, 52), label: undefined }]
          : [axis(xLabel, logX, 34), axis(yLabel, logY, 66)],
        legend: { show: !compact },
        series: [{ label: xLabel, value: (_, v) => number(v, 5) }, ...series.map(seriesOptions)],
        cursor: compact
          ? { show: false }
          : {
              drag: { x: true, y: false },
              points: { size: 7 },
              ...(overTime ? { sync: { key: kSync.key, filters: { pub: passed, sub: passed } } } : {}),
            },
        hooks: {
          setScale: [
            (u, key) => {
              if (overTime && key === 'x') [host.dataset.from, host.dataset.to] = [u.scales.x.min, u.scales.x.max];
              if (!plot) return;
              moveMark();
              if (overTime && key === 'x') zoomAlike(u);
            },
          ],
          setCursor: [(u) => onPoint?.(u)],
          draw: [
            (u) => {
              for (const level of levels) drawLevel(u, level);
              drawMarks(u, marks);
              drawLines(u, lines);
              drawEdgeMarks(u, edgeMarks?.() ?? []);
            },
          ],
        },
      },
      table,
      place,
    );
    link.plot = plot;
    plot.over.append(mark);
    plot.over.addEventListener('click', () => {
      if (onClick && plot.cursor.idx !== null && plot.select.width === 0) onClick(plot.cursor.idx);
    });
    moveMark();
  };
  build();
  rebuilds.push(build);
  new ResizeObserver(() => {
    const width = Math.max(260, place.clientWidth);
    if (width === plot.width) return;
    plot.setSize({ width, height });
    moveMark();
  }).observe(place);
  return {
    show(value) {
      shown = value;
      moveMark();
    },
    setTable(values) {
      table = values;
      plot.setData(table);
      host.dataset.points = table[0].length * (table.length - 1);
    },
  };
}
