// SPDX-License-Identifier: GPL-3.0-or-later
// The live page's messages and words, without a browser.
import assert from 'node:assert/strict';
import { leadMessage, letGoMessage, readFrame } from '../../tools/report/src/live_data.js';
import { readPad } from '../../tools/report/src/pad.js';
import { certificateWords, contactWords, deadlineWords, stateWords } from '../../tools/report/src/live_words.js';

const kHead = 43;

function frameOf(head, samples = [], contacts = []) {
  const buffer = new ArrayBuffer(8 * kHead + 4 * (samples.length + contacts.length));
  const numbers = new Float64Array(buffer, 0, kHead);
  numbers[0] = samples.length / 8;
  numbers[1] = contacts.length / 8;
  for (const [place, value] of Object.entries(head)) numbers[place] = value;
  new Float32Array(buffer, 8 * kHead).set([...samples, ...contacts]);
  return buffer;
}

const frame = readFrame(frameOf({ 2: 5, 4: 2, 6: 10, 14: 1e-4, 25: 2, 38: 0.5 }, [-0.5, 1, 2, 3, 4, 5, 6, 1], [1, 2, 3, 0, 0, 1, -1e-4, 0.5]), kHead);
assert.equal(frame.found, 5);
assert.deepEqual(frame.sent_N, [0, 0, 2]);
assert.equal(frame.hand[2], 0.5);
assert.equal(frame.samples[0].t_s, 9.5);
assert.equal(frame.samples[0].sent_N, 2);
assert.deepEqual(frame.contacts[0].normal, [0, 0, 1]);
assert.ok(frame.contacts[0].distance < 0);
assert.equal(frame.contacts[0].force_N, 0.5);

// What is no frame is not read.
assert.equal(readFrame(new ArrayBuffer(10), kHead), null);
assert.equal(readFrame(frameOf({ 0: 2 }), kHead), null);

const lead = new DataView(leadMessage([1, 2, 3], [0.1, 0.2, 0.3, 0.9]));
assert.equal(lead.byteLength, 64);
assert.equal(lead.getUint32(0, true), 1);
assert.equal(lead.getFloat64(8, true), 1);
assert.equal(lead.getFloat64(32, true), 0.9);  // w comes first
assert.equal(lead.getFloat64(40, true), 0.1);

const letGo = new DataView(letGoMessage());
assert.equal(letGo.byteLength, 8);
assert.equal(letGo.getUint32(0, true), 2);

const names = { states: ['disconnected', 'armed', 'rendering', 'fault', 'homing'], faults: ['stale_state', 'bad_state'] };
assert.equal(stateWords({ state: 2, faults: 0 }, names), 'rendering');
assert.equal(stateWords({ state: 1, faults: 0 }, names), 'armed: no force yet');
assert.equal(stateWords({ state: 3, faults: 1 }, names), 'fault: stale state; no force');
assert.equal(contactWords(frame), '5, 1 drawn; least distance 0.1 mm');
assert.equal(deadlineWords({ missed: 3, ticks: 1996 }), '3 missed of 2,000');
assert.equal(certificateWords({ contact: 0, force_bound_N: 0 }, 5e-4), 'nothing is nearer than 0.5 mm');
assert.equal(certificateWords({ contact: 1, force_bound_N: 0, cut: true }, 5e-4), 'a contact is not ruled out; not proved exact');

// Gamepads: rest, full way, triggers, and what is none of ours.
const pad = (axes, { values = {}, mapping = 'standard' } = {}) => ({
  mapping, axes, buttons: Array.from({ length: 17 }, (_, i) => ({ value: values[i] ?? 0, pressed: (values[i] ?? 0) > 0.5 })),
});
assert.deepEqual(readPad(pad([0.1, -0.14, 0, 0])), { move: [0, -0, 0], turn: [0, 0], letsGo: false });
assert.deepEqual(readPad(pad([1, -1, -1, 1])), { move: [1, 1, 0], turn: [-1, 1], letsGo: false });
assert.deepEqual(readPad(pad([5, NaN, 0, 0])).move, [1, -0, 0]);
assert.equal(readPad(pad([0, 0, 0, 0], { values: { 7: 1 } })).move[2], 1);
assert.equal(readPad(pad([0, 0, 0, 0], { values: { 6: 1 } })).move[2], -1);
assert.equal(readPad(pad([0, 0, 0, 0], { values: { 0: 1 } })).letsGo, true);
assert.ok(readPad(pad([0.5, 0, 0, 0])).move[0] < 0.25);  // fine near the middle
assert.equal(readPad(pad([1, 1, 1, 1], { mapping: '' })), null);
assert.equal(readPad(pad([1, 1])), null);
