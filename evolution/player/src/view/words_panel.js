// The words to choose from, lit while the agent hears them.

import { html, set } from "./svg.js";
import { ACTIONS, OBJECTS, actionsOf } from "../world/words.js";

let groups = 0;

/** Radio buttons for one kind of word; `onChoose(code)` is called where one is chosen. */
function makeGroup(host, codes, names, onChoose) {
  host.replaceChildren();
  const name = `wa-words-${(groups += 1)}`;
  return codes.map((code) => {
    const label = html(host, "label", { class: `wa-pill wa-${names[code].toLowerCase()}` });
    const input = html(label, "input", { type: "radio", name, value: code });
    html(label, "span", {}, names[code]);
    input.addEventListener("change", () => onChoose(code));
    return { code, label, input };
  });
}

/** Both kinds of words; `onChoose(part of an instruction)`. */
export function makeWords(find, condition, onChoose) {
  const pills = (part) => find(part).querySelector(".wa-pills");
  const kinds = {
    action: makeGroup(pills("actions"), actionsOf(condition), ACTIONS, (action) => onChoose({ action })),
    object: makeGroup(pills("objects"), [0, 1, 2], OBJECTS, (object) => onChoose({ object })),
  };
  return (instruction, silenced, lit) => {
    for (const [kind, group] of Object.entries(kinds)) {
      for (const { code, label, input } of group) {
        const chosen = instruction[kind] === code;
        if (input.checked !== chosen) input.checked = chosen;
        label.classList.toggle("wa-lit", chosen && lit && !silenced[kind]);
        label.classList.toggle("wa-silent", chosen && silenced[kind]);
      }
      set(find(`mute-${kind}`), { "aria-pressed": silenced[kind] });
    }
  };
}
