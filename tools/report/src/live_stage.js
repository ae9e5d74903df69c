// SPDX-License-Identifier: GPL-3.0-or-later
// The stage of a run that goes on: the newest frame, and the force's size beside its arrow.
import { floats } from './data.js';
import { Stage } from './stage.js';
import { number } from './units.js';

const kShown_N = 1e-3;

export class LiveStage extends Stage {
  #label = document.createElement('span');

  /// Throws where the browser has no WebGL.
  constructor(host, view) {
    super(host, view);
    view.bodies.forEach((body, index) => this.place(index, floats(body.track)));
    this.#label.className = 'force';
    this.#label.id = 'arrow';
    host.append(this.#label);
    this.controls.addEventListener('change', () => this.#moveLabel());
  }

  /// most_N: the force of the longest arrow.
  show(frame, most_N) {
    const force_N = Math.hypot(...frame.sent_N);
    this.place(this.view.tool, frame.tool);
    this.showContacts(frame.contacts);
    this.showForce(frame.sent_N, force_N > kShown_N ? force_N / Math.max(most_N, force_N) : 0);
    this.#label.textContent = `${number(force_N, 2)} N`;
    this.draw();
    this.#moveLabel();
  }

  #moveLabel() {
    const tip = this.arrowTip();
    this.#label.hidden = tip === null;
    if (tip) this.#label.style.transform = `translate(${tip.x + 8}px, ${tip.y - 10}px)`;
  }
}
