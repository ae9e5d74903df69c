// SPDX-License-Identifier: GPL-3.0-or-later
// A frame in words.
import { duration, length, number } from './units.js';

const kRuledOut = 0;
const kFound = 2;
const count = (n) => new Intl.NumberFormat('en').format(n);

export function stateWords(frame, names) {
  const faults = names.faults.filter((_, i) => (frame.faults >> i) & 1);
  if (faults.length > 0) return `fault: ${faults.join(', ').replaceAll('_', ' ')}; no force`;
  const state = names.states[frame.state];
  return state === 'armed' || state === 'homing' ? `${state}: no force yet` : state;
}

export function forceWords(frame) {
  const torque = Math.hypot(...frame.sent_Nm);
  return `${number(Math.hypot(...frame.sent_N))} N, ${number(torque)} N m`;
}

export function contactWords(frame) {
  if (frame.found === 0) return 'none';
  const shown = frame.contacts.length < frame.found ? `, ${frame.contacts.length} drawn` : '';
  const least = frame.least_m < 0 ? `overlap by ${length(-frame.least_m)}` : `least distance ${length(frame.least_m)}`;
  return `${count(frame.found)}${shown}; ${least}`;
}

export function certificateWords(frame, delta_m) {
  const bound = frame.force_bound_N > 0 ? `, force within ${number(frame.force_bound_N, 2)} N` : '';
  const cut = frame.cut ? '; not proved exact' : frame.onReserve ? '; on its reserve' : '';
  if (frame.contact === kFound) return `distance within ${length(frame.error_m)}${bound}${cut}`;
  return (frame.contact === kRuledOut ? `nothing is nearer than ${length(delta_m)}` : 'a contact is not ruled out') + cut;
}

export function deadlineWords(frame) {
  return `${count(frame.missed)} missed of ${count(frame.ticks + frame.missed + 1)}`;
}

export function tickWords(frame) {
  const { p50, p99, max } = frame.tick_us;
  return `${duration(p50)}, p99 ${duration(p99)}, longest ${duration(max)}; wake-up late by ${duration(frame.late_p99_us)} (p99)`;
}
