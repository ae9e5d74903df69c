// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of the report's page, without a browser.
import assert from 'node:assert/strict';
import { duration, fixed, length, number } from '../../tools/report/src/units.js';

assert.equal(fixed(-0.001, 2), '0.00');
assert.equal(fixed(-0.006, 2), '-0.01');
assert.equal(fixed(1.234, 2), '1.23');
assert.equal(number(null), '–');
assert.equal(duration(12), '12 µs');
assert.equal(length(0.002), '2 mm');
assert.equal(length(2e-6), '2 µm');
assert.equal(length(2e-9), '2 nm');
