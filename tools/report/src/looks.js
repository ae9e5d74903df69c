// SPDX-License-Identifier: GPL-3.0-or-later
// How each body of a stage is drawn.

export function addBodyChoices(host, view, stage) {
  view.bodies.forEach((body, index) => {
    const label = document.createElement('label');
    const choice = document.createElement('select');
    for (const look of ['solid', 'see-through', 'hidden']) choice.add(new Option(look, look));
    choice.value = index === view.tool ? 'see-through' : 'solid';
    choice.addEventListener('change', () => stage.setLook(index, choice.value));
    stage.setLook(index, choice.value);
    label.append(`${body.name} `, choice);
    host.append(label);
  });
}
