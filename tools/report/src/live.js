// SPDX-License-Identifier: GPL-3.0-or-later
// The live page of `palpate run --view`: shows what the run says, and leads its hand.
import './style.css';
import './live.css';
import { readData } from './data.js';
import { Hand } from './hand.js';
import { leadMessage, letGoMessage, readFrame } from './live_data.js';
import { LiveStage } from './live_stage.js';
import { certificateWords, contactWords, deadlineWords, forceWords, stateWords, tickWords } from './live_words.js';
import { addBodyChoices } from './looks.js';
import { Pad } from './pad.js';
import { Strip } from './strip.js';

const kWordsEvery_ms = 100;
const kTries = 5;
const kTryAgain_ms = 1000;

const at = (id) => document.getElementById(id);
const data = readData();
const { view } = data;
const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

let socket = null;
let stage = null;
let hand = null;
let newest = null;
let pending = false;
let said_ms = 0;
let tries = 0;

document.title = `${data.name} – live`;
at('title').textContent = data.name;
at('made').textContent = `Live view of a run on ${data.device === 'mouse' ? 'the mouse' : `the device ${data.device}`}, ${data.rate_Hz} Hz. Palpate ${data.version}.`;
at('how').hidden = !data.lead;
const strip = new Strip(
  { force: at('force'), torque: at('torque'), energy: at('energy'), time: at('time') },
  { seconds: data.strip_s, budget_us: data.budget_us, rate_Hz: data.rate_Hz },
);

function link(state, text) {
  at('link').dataset.state = state;
  at('link').textContent = text;
}

function send(wanted) {
  if (socket?.readyState !== WebSocket.OPEN) return;
  socket.send(wanted ? leadMessage(wanted.position.toArray(), wanted.orientation.toArray()) : letGoMessage());
}

try {
  stage = new LiveStage(at('stage'), view);
  addBodyChoices(at('bodies'), view, stage);
  stage.lookAtAll();
  at('fit').addEventListener('click', () => stage.lookAtAll());
  at('near').addEventListener('click', () => stage.lookAtContacts());
  if (data.lead) {
    hand = new Hand(stage, view.tool, view.images[view.bodies[view.tool].image].centre_m, send);
    new Pad(hand, at('pad'));
    const paint = () => hand.paint(style('--accent'));
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', paint);
    paint();
  }
} catch (error) {
  if (stage) throw error;
  at('stage').textContent = 'This browser does not show 3D (WebGL is off or missing).';
}

function showWords(frame) {
  at('state').textContent = stateWords(frame, data.names);
  at('wrench').textContent = forceWords(frame);
  at('contacts').textContent = contactWords(frame);
  at('certificate').textContent = certificateWords(frame, view.delta_m);
  at('deadlines').textContent = deadlineWords(frame);
  at('tick').textContent = tickWords(frame);
  at('state').parentElement.classList.toggle('bad', frame.faults !== 0);
  at('deadlines').parentElement.classList.toggle('bad', frame.missed > 0);
}

/// As often as the display draws.
function show(now_ms) {
  pending = false;
  stage?.show(newest, strip.most_N());
  hand?.follow(newest.hand);
  strip.draw(now_ms, newest.ended);
  if (now_ms - said_ms < kWordsEvery_ms && !newest.ended) return;
  said_ms = now_ms;
  showWords(newest);
}

function take(frame) {
  newest = frame;
  strip.push(frame.samples);
  if (pending) return;
  pending = true;
  requestAnimationFrame(show);
}

function connect() {
  socket = new WebSocket(`ws://${location.host}${location.pathname}live`);
  socket.binaryType = 'arraybuffer';
  socket.addEventListener('open', () => {
    tries = 0;
    link('live', 'live');
  });
  socket.addEventListener('message', (event) => {
    const frame = readFrame(event.data, data.head_numbers);
    if (frame) take(frame);
    if (frame?.ended) link('ended', 'The run has ended: its summary is in the terminal.');
  });
  socket.addEventListener('close', () => {
    if (newest?.ended) return;
    if (++tries > kTries) {
      link('lost', 'No connection: the run has ended, or four other pages show it.');
      return;
    }
    link('lost', 'No connection; trying again.');
    setTimeout(connect, kTryAgain_ms);
  });
}
connect();
