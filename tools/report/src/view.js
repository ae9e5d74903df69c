// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D view and its controls.
import { counts, floats } from './data.js';
import { addBodyChoices } from './looks.js';
import { RecordedStage } from './recorded_stage.js';
import { fixed, millimetres, number } from './units.js';

const at = (id) => document.getElementById(id);
const kNotShown = 0xffffffff;

/// The contacts of each frame, with both sides by name.
class Contacts {
  constructor(packed) {
    this.starts = counts(packed.starts);
    this.found = counts(packed.found);
    this.points = floats(packed.points);
    this.distances = floats(packed.distances);
    this.forces_N = floats(packed.forces_N);
    this.sides = counts(packed.sides);
  }

  ofFrame(frame) {
    const out = [];
    for (let i = this.starts[frame]; i < this.starts[frame + 1]; ++i) {
      const side = (k) => {
        const [body, place, level] = this.sides.subarray(6 * i + 3 * k, 6 * i + 3 * k + 3);
        return { body, place: place === kNotShown ? null : place, level, point: this.points.subarray(6 * i + 3 * k, 6 * i + 3 * k + 3) };
      };
      out.push({ distance: this.distances[i], force_N: this.forces_N[i], a: side(0), b: side(1) });
    }
    return out;
  }
}

/// "level 0: 3, level 4: 12"
function levelsOf(contacts, body) {
  const pieces = new Map();
  for (const side of contacts.flatMap((c) => [c.a, c.b])) {
    if (side.body !== body) continue;
    if (!pieces.has(side.level)) pieces.set(side.level, new Set());
    pieces.get(side.level).add(side.place);
  }
  return [...pieces]
    .sort((x, y) => x[0] - y[0])
    .map(([level, set]) => `level ${level}: ${set.size}`)
    .join(', ');
}

function describe(view, data, frame, contacts, found, stage) {
  const tick = frame * data.shown.stride;
  const force = Math.hypot(...stage.forceAt(frame));
  const position = stage.positionOf(view.tool, frame);
  const least = contacts.reduce((d, c) => Math.min(d, c.distance), Infinity);
  const shown = contacts.length < found ? `${contacts.length} of ${found} contacts shown` : `${found} contacts`;
  const pieces = view.bodies
    .map((body, i) => [body.name, levelsOf(contacts, i)])
    .filter(([, levels]) => levels !== '')
    .map(([name, levels]) => `Pieces of ${name}: ${levels}.`);
  return (
    `Tick ${tick}, ${number(stage.times[frame], 4)} s. Force ${number(force)} N. ${shown}` +
    `${found > 0 ? `, least distance ${millimetres(least)}` : ''}. ` +
    `Tool moved by (${Array.from(position, (v) => fixed(1e3 * v, 2)).join(', ')}) mm. ${pieces.join(' ')}`
  );
}

function addLegend(view, stage) {
  const levels = Math.max(...view.images.map((image) => image.levels));
  const entry = (colour, text) => {
    const item = document.createElement('span');
    const chip = document.createElement('i');
    chip.style.background = colour;
    item.append(chip, text);
    at('levels').append(item);
  };
  for (let level = 0; level < levels; ++level) {
    const name = level === 0 ? 'level 0, the original surface' : level === levels - 1 ? `${level}, one piece` : `${level}`;
    entry(stage.colourOfLevel(level, levels), name);
  }
  entry('var(--overlap)', 'contact where the pieces overlap');
  entry('var(--ink)', 'contact with a gap');
  entry('var(--series-3)', 'rim of a contact that carries force');
}

function addTransport(playhead, times) {
  const slider = at('frame');
  slider.max = playhead.count - 1;
  slider.addEventListener('input', () => playhead.set(slider.valueAsNumber));
  playhead.onChange((frame) => {
    slider.value = frame;
  });
  const button = at('play');
  const last = times.length - 1;
  let timer = null;
  let before = 0;
  let time = 0;
  /// Along the recording's own times, whatever the display's rate; from the end it starts over.
  const step = (now) => {
    time += (Number(at('speed').value) * (now - before)) / 1000;
    before = now;
    if (time > times[last]) time = times[0];
    let frame = playhead.frame;
    while (frame < last && times[frame + 1] <= time) ++frame;
    while (frame > 0 && times[frame] > time) --frame;
    if (frame !== playhead.frame) playhead.set(frame);
    timer = requestAnimationFrame(step);
  };
  playhead.onChange((frame) => {
    // Moved by hand: go on from there.
    if (times[frame] > time || times[Math.min(frame + 1, last)] <= time) time = times[frame];
  });
  button.addEventListener('click', () => {
    if (timer !== null) {
      cancelAnimationFrame(timer);
      timer = null;
    } else {
      before = performance.now();
      time = times[playhead.frame];
      timer = requestAnimationFrame(step);
    }
    button.textContent = timer === null ? 'Play' : 'Pause';
    button.setAttribute('aria-pressed', String(timer !== null));
  });
}

export function showView(data, playhead) {
  const { view } = data;
  at('view').hidden = false;
  at('origin').textContent =
    `${view.origin} ` +
    view.bodies
      .map(({ name, image }) => {
        const { level, triangles, source_triangles: source } = view.images[image];
        return `${name} is drawn at level ${level} (${number(triangles, 6)} of ${number(source, 7)} triangles).`;
      })
      .join(' ');
  const contacts = new Contacts(view.contacts);
  let stage;
  try {
    stage = new RecordedStage(at('stage'), view, floats(data.shown.t_s));
  } catch {
    at('stage').textContent = 'This browser does not show 3D (WebGL is off or missing).';
    return;
  }
  addTransport(playhead, floats(data.shown.t_s));
  addBodyChoices(at('bodies'), view, stage);
  addLegend(view, stage);
  const show = (frame) => {
    const shown = contacts.ofFrame(frame);
    stage.show(frame, shown);
    at('reading').textContent = describe(view, data, frame, shown, contacts.found[frame], stage);
  };
  playhead.onChange(show);
  at('fit').addEventListener('click', () => stage.lookAtAll());
  at('near').addEventListener('click', () => stage.lookAtContacts());
  playhead.set(stage.strongestFrame());  // begin where there is something to see
  stage.lookAtAll();
}
