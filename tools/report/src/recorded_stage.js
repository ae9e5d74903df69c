// SPDX-License-Identifier: GPL-3.0-or-later
// The stage of a recording: shows one of its frames.
import { floats } from './data.js';
import { Stage } from './stage.js';

export class RecordedStage extends Stage {
  /// Throws where the browser has no WebGL.
  constructor(host, view, times) {
    super(host, view);
    this.times = times;
    this.forces = floats(view.force_N);
    this.tracks = view.bodies.map((body) => floats(body.track));
    this.most_N = Math.hypot(...this.forceAt(this.strongestFrame()));
  }

  /// The frame in which the tool feels most.
  strongestFrame() {
    let best = 0;
    for (let frame = 1; 3 * frame < this.forces.length; ++frame) {
      if (Math.hypot(...this.forceAt(frame)) > Math.hypot(...this.forceAt(best))) best = frame;
    }
    return best;
  }

  forceAt(frame) {
    return this.forces.subarray(3 * frame, 3 * frame + 3);
  }

  positionOf(body, frame) {
    return this.tracks[body].subarray(7 * frame, 7 * frame + 3);
  }

  show(frame, contacts) {
    this.tracks.forEach((track, index) => this.place(index, track, 7 * frame));
    const between = (a, b) => Array.from(a, (x, k) => (x + b[k]) / 2);
    this.showContacts(contacts.map((c) => ({ ...c, point: between(c.a.point, c.b.point) })));
    const force = this.forceAt(frame);
    this.showForce(force, this.most_N);
    this.draw();
  }
}
