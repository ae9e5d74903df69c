// SPDX-License-Identifier: GPL-3.0-or-later
// The stage of a run that goes on: the newest frame.
import { floats } from './data.js';
import { Stage } from './stage.js';

export class LiveStage extends Stage {
  /// Throws where the browser has no WebGL.
  constructor(host, view) {
    super(host, view);
    view.bodies.forEach((body, index) => this.place(index, floats(body.track)));
  }

  /// most_N: the force of the longest arrow.
  show(frame, most_N) {
    this.place(this.view.tool, frame.tool);
    this.showContacts(frame.contacts);
    this.showForce(frame.sent_N, most_N);
    this.draw();
  }
}
