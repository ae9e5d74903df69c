// SPDX-License-Identifier: GPL-3.0-or-later
// What lies over a page's 3D view: the same on both pages.
import assert from 'node:assert/strict';

const kStep_px = 7;

export async function checkOverStage(browser) {
  const axes = await browser.value(`[...document.querySelectorAll('#stage .axes text')].map((label) => label.textContent).sort().join('')`);
  assert.equal(axes, 'xyz');
  const scale = await browser.value(`(({ textContent, offsetWidth }) => ({ textContent, offsetWidth }))(document.querySelector('#stage .scale'))`);
  assert.match(scale.textContent, /^[125]0* [mµn]m$|^0\.[0-9]+ mm$/);
  assert.ok(scale.offsetWidth > 45 && scale.offsetWidth <= 135, `a scale of ${scale.offsetWidth} px`);
}

/// What the page says of a contact, once one is found under the pointer: "Go to the contacts" brings them to the middle.
export async function readContact(browser) {
  await browser.value('document.getElementById("near").click()');
  await browser.value('document.getElementById("stage").scrollIntoView({ block: "center" })');
  await browser.drawn();
  const box = await browser.value('(({ x, y, width, height }) => ({ x, y, width, height }))(document.getElementById("stage").getBoundingClientRect())');
  for (let ring = 0; ring * kStep_px < box.height / 2; ++ring) {
    for (let i = 0; i < Math.max(1, 6 * ring); ++i) {
      const angle = (2 * Math.PI * i) / Math.max(1, 6 * ring);
      await browser.mouse('mouseMoved', box.x + box.width / 2 + ring * kStep_px * Math.cos(angle), box.y + box.height / 2 + ring * kStep_px * Math.sin(angle));
      await browser.drawn();
      const said = await browser.value('(({ hidden, textContent }) => (hidden ? null : textContent))(document.getElementById("contact"))');
      if (said) return said;
    }
  }
  return assert.fail('no contact says what it is');
}
