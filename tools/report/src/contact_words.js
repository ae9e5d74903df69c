// SPDX-License-Identifier: GPL-3.0-or-later
// A contact that is pointed at, in words.
import { length, number } from './units.js';

/// Lines of text. contact: {distance, force_N, a?, b?}; bodies: [{name}]
export function contactTip({ distance, force_N, a, b }, bodies) {
  const apart = distance < 0 ? `overlap ${length(-distance)}` : `gap ${length(distance)}`;
  const carries = force_N > 0 ? `carries ${number(force_N, 2)} N` : 'carries nothing';
  const levels = [a, b].filter((side) => side).map((side) => `${bodies[side.body].name} at level ${side.level}`);
  return [`${apart}, ${carries}`, ...(levels.length > 0 ? [levels.join(', ')] : [])];
}
