// SPDX-License-Identifier: GPL-3.0-or-later
// One colour for one thing, in every plot and in 3D: places in the style sheet's series.

/// Of a run. The force's arrow has that of what was sent, the axes in 3D those of x, y and z.
export const kOfRun = { computed: 0, sent: 3, x: 1, y: 2, z: 5, tick: 0, late: 4, energy: 6, age: 7 };

/// A setting has the colour of its line in the profiles; null where it has none.
export function colourOfSetting(setting, lines) {
  const place = lines.findIndex((line) => line.name === `${setting.engine}, ${setting.words}`);
  return place < 0 ? null : place;
}
