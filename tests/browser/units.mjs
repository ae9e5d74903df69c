// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of the report's page, without a browser.
import assert from 'node:assert/strict';
import { colourOfSetting } from '../../tools/report/src/colours.js';
import { contactTip } from '../../tools/report/src/contact_words.js';
import { duration, fixed, length, number, roundLength } from '../../tools/report/src/units.js';

assert.equal(fixed(-0.001, 2), '0.00');
assert.equal(fixed(-0.006, 2), '-0.01');
assert.equal(fixed(1.234, 2), '1.23');
assert.equal(number(null), '–');
assert.equal(duration(12), '12 µs');
assert.equal(length(0.002), '2 mm');
assert.equal(length(2e-6), '2 µm');
assert.equal(length(2e-9), '2 nm');

for (const [most, expected] of [[0.0099, 0.005], [0.01, 0.01], [0.03, 0.02], [1.99e-7, 1e-7], [7, 5], [1000, 1000]]) {
  assert.ok(Math.abs(roundLength(most) / expected - 1) < 1e-9, `${most}`);
}

const bodies = [{ name: 'pin' }, { name: 'plate' }];
assert.deepEqual(contactTip({ distance: 2e-4, force_N: 0 }, bodies), ['gap 0.2 mm, carries nothing']);
assert.deepEqual(contactTip({ distance: -2e-6, force_N: 0.25, a: { body: 0, level: 1 }, b: { body: 1, level: 0 } }, bodies), [
  'overlap 2 µm, carries 0.25 N',
  'pin at level 1, plate at level 0',
]);

const lines = [{ name: 'levels, exact' }, { name: 'regions, s0 = 0.1' }];
assert.equal(colourOfSetting({ engine: 'regions', words: 's0 = 0.1' }, lines), 1);
assert.equal(colourOfSetting({ engine: 'levels', words: 's0 = 0.1' }, lines), null);
