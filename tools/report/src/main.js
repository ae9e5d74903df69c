// SPDX-License-Identifier: GPL-3.0-or-later
// The page of `palpate report`: shows what the program computed, and computes nothing of its own.
import './style.css';
import { readData } from './data.js';
import { Playhead } from './playhead.js';
import { showCertificate, showLatency, showProfiles, showRun } from './ticks.js';
import { showTrade } from './trade.js';
import { showView } from './view.js';

const kinds = { sweep: 'Sweep of settings', replay: 'Replay of recorded poses', run: 'Run against a device' };

function fillList(id, items) {
  const list = document.getElementById(id);
  for (const text of items) {
    const item = document.createElement('li');
    item.textContent = text;
    list.append(item);
  }
}

const data = readData();
document.title = `${data.name} – Palpate report`;
document.getElementById('title').textContent = data.name;
document.getElementById('made').textContent = `${kinds[data.kind]}. Made by palpate ${data.version}.`;
fillList('words', data.summary);
fillList('notes', data.notes);

// The frames of the 3D view; plots may show more of the ticks.
data.shown = data.view?.frames ?? data.frames;
const playhead = new Playhead(data.shown?.count ?? 1);
if (data.settings.length > 0) showTrade(document.getElementById('trade'), data.settings, data.lines);
if (data.view) showView(data, playhead);
if (data.lines.length > 0) showProfiles(data, playhead);
if (data.run) showRun(data, playhead);
if (data.latency) showLatency(data, playhead);
showCertificate(data, playhead);
