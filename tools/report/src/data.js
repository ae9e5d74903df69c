// SPDX-License-Identifier: GPL-3.0-or-later
// The page's data: what tools/palpate/report_json.cpp wrote into it.

function bytes(text) {
  const binary = atob(text);
  const out = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) out[i] = binary.charCodeAt(i);
  return out.buffer;
}

export const floats = (text) => new Float32Array(bytes(text));
export const counts = (text) => new Uint32Array(bytes(text));

export const readData = () => JSON.parse(document.getElementById('data').textContent);
