// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as people read them.

export function number(value, digits = 3) {
  if (value === null || value === undefined || Number.isNaN(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  return size >= 1e-3 && size < 1e7
    ? new Intl.NumberFormat('en', { maximumSignificantDigits: digits }).format(value)
    : value.toExponential(digits - 1).replace(/\.?0+e/, 'e');
}

/// With so many digits behind the point; what rounds to zero has no sign.
export function fixed(value, digits) {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? (0).toFixed(digits) : text;
}

export const percent = (share) => (share === null ? '–' : `${number(100 * share)} %`);
export const millimetres = (metres) => (metres === null ? '–' : `${number(1e3 * metres)} mm`);

/// In the unit that suits it.
export function length(metres) {
  if (metres === null || Number.isNaN(metres)) return '–';
  const size = Math.abs(metres);
  if (size >= 1e-4 || size === 0) return millimetres(metres);
  return size >= 1e-7 ? `${number(1e6 * metres)} µm` : `${number(1e9 * metres)} nm`;
}

/// The longest of 1, 2 and 5 times a power of ten that is no longer than `most`.
export function roundLength(most) {
  const power = 10 ** Math.floor(Math.log10(most) + 1e-9);
  return power * [5, 2, 1].find((digit) => digit * power <= most * (1 + 1e-9));
}

export function duration(us) {
  if (us === null || Number.isNaN(us)) return 'not timed';
  if (us < 1) return `${number(us * 1e3)} ns`;
  return us < 1000 ? `${number(us)} µs` : `${number(us * 1e-3)} ms`;
}
