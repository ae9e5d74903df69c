// SPDX-License-Identifier: GPL-3.0-or-later
// What the program and the live page say to each other: the page's half of tools/live/messages.hpp.

export const kMarks = { missed: 1, fault: 2, cut: 4 };
const kSampleNumbers = 8;
const kContactNumbers = 8;

/// One frame; null where it is not one.
export function readFrame(buffer, headNumbers) {
  if (buffer.byteLength < 8 * headNumbers) return null;
  const head = new Float64Array(buffer, 0, headNumbers);
  const rest = new Float32Array(buffer, 8 * headNumbers);
  const [samples, contacts] = head;
  if (rest.length !== kSampleNumbers * samples + kContactNumbers * contacts) return null;
  const from = (first, count) => Array.from(head.subarray(first, first + count));
  return {
    found: head[2],
    ended: head[3] === 1,
    state: head[4],
    faults: head[5],
    t_s: head[6],
    ticks: head[7],
    missed: head[8],
    tick_us: { p50: head[9], p99: head[10], max: head[11] },
    late_p99_us: head[12],
    age_us: head[13],
    least_m: head[14],
    error_m: head[15],
    force_bound_N: head[16],
    contact: head[17],
    cut: (head[18] & 1) !== 0,
    onReserve: (head[18] & 2) !== 0,
    energy_J: head[19],
    rendered_N: from(20, 3),
    sent_N: from(23, 3),
    sent_Nm: from(26, 3),
    tool: from(29, 7),
    hand: from(36, 7),
    samples: Array.from({ length: samples }, (_, i) => {
      const s = rest.subarray(kSampleNumbers * i, kSampleNumbers * (i + 1));
      return {
        t_s: head[6] + s[0], rendered_N: s[1], sent_N: s[2], sent_Nm: s[3], energy_mJ: 1e3 * s[4], tick_us: s[5], late_us: s[6], marks: s[7],
      };
    }),
    contacts: Array.from({ length: contacts }, (_, i) => {
      const c = rest.subarray(kSampleNumbers * samples + kContactNumbers * i);
      return { point: Array.from(c.subarray(0, 3)), normal: Array.from(c.subarray(3, 6)), distance: c[6], force_N: c[7] };
    }),
  };
}

/// The hand lets go.
export function letGoMessage() {
  return new Uint32Array([2, 0]).buffer;
}

/// Where the hand wants the tool: position [x, y, z], orientation [x, y, z, w].
export function leadMessage(position, [x, y, z, w]) {
  const view = new DataView(new ArrayBuffer(64));
  view.setUint32(0, 1, true);
  [...position, w, x, y, z].forEach((value, i) => view.setFloat64(8 + 8 * i, value, true));
  return view.buffer;
}
