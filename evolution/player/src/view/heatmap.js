// Nine instructions as a map of three by three, painted as counts come in.

import { PER_AREA } from "../world/census.js";
import { html, set, write } from "./svg.js";
import { ACTIONS, OBJECTS, actionsOf, neverMet, spoken } from "../world/words.js";

export const TRIALS = 2 * PER_AREA;

/** A map in `table`; `onChoose(instruction)` is called where a cell is chosen. */
export function makeMap(table, condition, onChoose) {
  const [head, body] = [table.tHead, table.tBodies[0]];
  head.replaceChildren();
  body.replaceChildren();
  const top = html(head, "tr");
  html(top, "td");
  OBJECTS.forEach((object) => html(top, "th", { scope: "col", class: `wa-${object.toLowerCase()}` }, object));
  const cells = actionsOf(condition).flatMap((action) => {
    const row = html(body, "tr");
    html(row, "th", { scope: "row" }, ACTIONS[action]);
    return [0, 1, 2].map((object) => makeCell(html(row, "td"), { action, object }, onChoose));
  });
  return {
    /** Paint the reader's counts so far, beside the ones we had; or ours alone, where nothing was counted. */
    show: (counts, ours) => cells.forEach((cell, k) => cell.show(counts ? counts[k] : ours[k], counts && ours[k])),
    /** Frame the instruction that is being carried out. */
    mark: (instruction) => cells.forEach((cell) => cell.mark(instruction)),
  };
}

function makeCell(parent, instruction, onChoose) {
  const button = html(parent, "button", { type: "button", class: neverMet(instruction) ? "wa-never" : "" });
  const [count, small] = [html(button, "b"), html(button, "small")];
  button.addEventListener("click", () => onChoose(instruction));
  return {
    show(successes, beside) {
      const known = successes !== undefined;
      write(count, known ? String(successes) : "·");
      write(small, beside === null ? `of ${TRIALS}` : `ours: ${beside}`);
      const never = neverMet(instruction) ? ", never practised" : "";
      const said = known ? `${successes} of ${TRIALS}` : "being counted";
      const besides = beside === null ? "" : `, ours ${beside} of ${TRIALS}`;
      set(button, { "aria-label": `${spoken(instruction)}${never}: ${said}${besides}` });
      paint(button, known ? successes / TRIALS : null);
    },
    mark(chosen) {
      const same = chosen.action === instruction.action && chosen.object === instruction.object;
      set(button, { "aria-pressed": same });
    },
  };
}

/** A colour between those of no success and of full success, and letters that can be read on it. */
function paint(button, share) {
  if (share === null) {
    button.style.background = button.style.color = "";
    return;
  }
  const style = getComputedStyle(button);
  const [none, all] = ["--wa-none", "--wa-all"].map((name) => rgb(style.getPropertyValue(name).trim()));
  const mixed = none.map((value, k) => Math.round(value + (all[k] - value) * share));
  button.style.background = `rgb(${mixed.join(" ")})`;
  button.style.color = luminance(mixed) > 0.179 ? "#000" : "#fff"; // either way at least 4.5 to 1
}

function rgb(hex) {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
}

/** Relative luminance, as WCAG defines it. */
export function luminance(channels) {
  const [r, g, b] = channels.map((value) => {
    const part = value / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}
