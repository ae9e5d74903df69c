// SPDX-License-Identifier: GPL-3.0-or-later
// A gamepad as the hand, beside the mouse: its sticks say how fast the hand goes, and where they rest it stays.

const kRest = 0.15;  // of a stick's way: nearer to its middle it counts as at rest
const kLetGo = 0;    // A, or the cross
const kAway = 6;     // left trigger
const kTowards = 7;  // right trigger
const kLongest_s = 0.1;  // of a frame: a page that was away does not leap

/// Fine near the middle.
function bent(value) {
  const size = Number.isFinite(value) ? Math.min(Math.abs(value), 1) : 0;
  return size <= kRest ? 0 : Math.sign(value) * ((size - kRest) / (1 - kRest)) ** 2;
}

/// What a gamepad of the standard layout says: {move: [right, up, away], turn: [about up, about right], letsGo}, each -1 to 1;
/// null of another layout, whose axes may mean anything.
export function readPad(pad) {
  if (pad.mapping !== 'standard' || pad.axes.length < 4) return null;
  const trigger = (i) => bent(pad.buttons[i]?.value ?? 0);
  return {
    move: [bent(pad.axes[0]), -bent(pad.axes[1]), trigger(kTowards) - trigger(kAway)],
    turn: [bent(pad.axes[2]), bent(pad.axes[3])],
    letsGo: pad.buttons[kLetGo]?.pressed ?? false,
  };
}

export class Pad {
  #hand;
  #said;
  #last_ms = null;

  /// said: where it says which gamepad is there, and whether it can be used.
  constructor(hand, said) {
    this.#hand = hand;
    this.#said = said;
    for (const type of ['gamepadconnected', 'gamepaddisconnected']) addEventListener(type, () => this.#look());
    document.addEventListener('visibilitychange', () => document.hidden && hand.dropPush());
    this.#look();
  }

  #pads() {
    return [...(navigator.getGamepads?.() ?? [])].filter((pad) => pad?.connected);
  }

  #look() {
    const pads = this.#pads();
    const used = pads.find(readPad);
    this.#said.textContent = used
      ? `In use: ${used.id}.`
      : pads.length > 0 ? `Not used: ${pads[0].id}, whose layout is not the standard one.` : 'Press one of its buttons to begin.';
    if (!used) this.#hand.dropPush();
    if (used && this.#last_ms === null) {
      this.#last_ms = performance.now();
      requestAnimationFrame((now) => this.#step(now));
    }
  }

  #step(now) {
    const pad = this.#pads().find(readPad);
    if (!pad) {
      this.#last_ms = null;
      return this.#look();
    }
    const seconds = Math.min(Math.max((now - this.#last_ms) / 1000, 0), kLongest_s);
    this.#last_ms = now;
    const { move, turn, letsGo } = readPad(pad);
    if (letsGo) this.#hand.dropPush();
    else this.#hand.push(move, turn, seconds);
    requestAnimationFrame((next) => this.#step(next));
  }
}
