// SPDX-License-Identifier: GPL-3.0-or-later
// The frame that the whole page shows.

export class Playhead {
  #listeners = [];
  frame = 0;

  constructor(count) {
    this.count = count;
  }

  set(frame) {
    this.frame = Math.max(0, Math.min(this.count - 1, Math.round(frame)));
    for (const listener of this.#listeners) listener(this.frame);
  }

  onChange(listener) {
    this.#listeners.push(listener);
  }
}
