// SPDX-License-Identifier: GPL-3.0-or-later
// What lies over a 3D view as text and lines: the world's axes, a scale, the force's size at its arrow, and what is known of the
// contact under the pointer.
import { Vector3 } from 'three';
import { contactTip } from './contact_words.js';
import { length, roundLength } from './units.js';

const kAxes = [['x', [1, 0, 0]], ['y', [0, 1, 0]], ['z', [0, 0, 1]]];
const kAxesSize_px = 84;
const kAxis_px = 28;
const kLongestScale_px = 130;
const kReach_px = 14;
const kEdge_px = 4;

function svg(name, attributes = {}) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
}

function span(host, className) {
  const element = document.createElement('span');
  element.className = className;
  host.append(element);
  return element;
}

export class Overlay {
  #host;
  #bodies;
  #axes;
  #scale;
  #force;
  #tip;
  #pointer = null;  ///< {x, y} in the host, while it points

  constructor(host, bodies) {
    this.#host = host;
    this.#bodies = bodies;
    this.#axes = this.#addAxes();
    this.#scale = span(host, 'scale');
    this.#force = span(host, 'force');
    this.#force.id = 'arrow';
    this.#tip = span(host, 'tip');
    this.#tip.id = 'contact';
    this.#tip.hidden = true;
  }

  /// Where the pointer is, in the window; null where it is nowhere or busy.
  point(event) {
    const box = this.#host.getBoundingClientRect();
    this.#pointer = event && { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  /// force: {text, at: {x, y} | null}; contacts: [{distance, force_N, a?, b?}]; pixelOf(i): where one of them is, or null;
  /// metresPerPixel: at what the view turns about.
  draw(camera, { force, contacts, pixelOf, metresPerPixel }) {
    this.#drawAxes(camera);
    this.#drawScale(metresPerPixel);
    this.#force.hidden = force.at === null;
    this.#force.textContent = force.text;
    if (force.at) this.#put(this.#force, force.at.x + 8, force.at.y - 10);
    this.#drawTip(contacts, pixelOf);
  }

  #addAxes() {
    const picture = svg('svg', { class: 'axes', width: kAxesSize_px, height: kAxesSize_px, 'aria-hidden': 'true' });
    const parts = kAxes.map(([name, along]) => {
      const line = svg('line', { x1: kAxesSize_px / 2, y1: kAxesSize_px / 2, class: name });
      const label = svg('text', { class: name });
      label.textContent = name;
      return { along: new Vector3(...along), line, label };
    });
    this.#host.append(picture);
    return { picture, parts };
  }

  /// Those that point away from the viewer first.
  #drawAxes(camera) {
    const turned = camera.quaternion.clone().invert();
    const seen = this.#axes.parts.map((part) => ({ ...part, at: part.along.clone().applyQuaternion(turned) }));
    const middle = kAxesSize_px / 2;
    for (const { line, label, at } of seen.sort((p, q) => p.at.z - q.at.z)) {
      line.setAttribute('x2', middle + kAxis_px * at.x);
      line.setAttribute('y2', middle - kAxis_px * at.y);
      label.setAttribute('x', middle + (kAxis_px + 8) * at.x);
      label.setAttribute('y', middle - (kAxis_px + 8) * at.y);
      this.#axes.picture.append(line, label);
    }
  }

  #drawScale(metresPerPixel) {
    const metres = roundLength(kLongestScale_px * metresPerPixel);
    this.#scale.textContent = length(metres);
    this.#scale.style.width = `${metres / metresPerPixel}px`;
  }

  #drawTip(contacts, pixelOf) {
    let nearest = null;
    let least_px = kReach_px;
    contacts.forEach((contact, i) => {
      const at = this.#pointer && pixelOf(i);
      const away_px = at ? Math.hypot(at.x - this.#pointer.x, at.y - this.#pointer.y) : Infinity;
      if (away_px > least_px) return;
      least_px = away_px;
      nearest = { contact, at };
    });
    this.#tip.hidden = nearest === null;
    if (!nearest) return;
    this.#tip.textContent = contactTip(nearest.contact, this.#bodies).join('\n');
    this.#put(this.#tip, nearest.at.x + 14, nearest.at.y + 14);
  }

  /// There, or as near to it as it is whole.
  #put(label, x, y) {
    const within = (at, room) => Math.max(kEdge_px, Math.min(at, room - kEdge_px));
    const left = within(x, this.#host.clientWidth - label.offsetWidth);
    const top = within(y, this.#host.clientHeight - label.offsetHeight);
    label.style.transform = `translate(${left}px, ${top}px)`;
  }
}
