// The words, the verdict, the senses and the motors beside the picture.

import { OBJECTS } from "./scene.js";

const part = (id) => document.getElementById(id);
const title = (word) => word[0] + word.slice(1).toLowerCase();
const MOTORS = [["upper arm", "stays", "turns"], ["", "left", "right"], ["forearm", "stays", "turns"], ["", "bends", "stretches"]];
const NOTES = {
  open: "Its senses are those of the planar arm, and the robot's hand goes where that arm's end goes.",
  closed: "Its senses are the robot's: hand, skin and eyes. It is answered a tenth of a second later than it ever was in evolution.",
};
// Sector 1 is the rightmost; the robot faces the reader, so it stands on the left.
const SECTORS = ["its right", "ahead", "its left"];

/** An element with a class, put into another. */
function add(home, name, kind = "", text = "") {
  const made = document.createElement(name);
  if (kind) made.className = kind;
  if (text) made.textContent = text;
  home.append(made);
  return made;
}

/** Words to choose from; `said` is told the one that is chosen. */
export function words(actions, said) {
  const pills = (home, name, all) => {
    home.replaceChildren();
    for (const word of all) {
      const label = add(home, "label", `pill ${word.toLowerCase()}`);
      const input = add(label, "input");
      Object.assign(input, { type: "radio", name, value: word });
      add(label, "span", "", name === "action" ? word : title(word));
      input.addEventListener("change", () => said(word));
    }
  };
  pills(part("actions"), "action", actions);
  pills(part("objects"), "object", OBJECTS.map((name) => name.toUpperCase()));
}

/** Lamps and bars, once; a function that sets them by a state. */
export function insides() {
  const lamps = senses(part("senses"));
  const dots = motors(part("motors"));
  return ({ inputs, motors: values }) => {
    for (const [lamp, index] of lamps) {
      if (index === 11) lamp.style.width = `${100 * inputs[11]}%`;
      else lamp.classList.toggle("on", inputs[index] > 0.5);
    }
    dots.forEach((dot, k) => (dot.style.left = `${100 * values[k]}%`));
  };
}

/** [element, input] of every sense. */
function senses(home) {
  home.replaceChildren();
  const all = [];
  const lamp = (where, index, kind = "") => all.push([add(where, "b", `lamp ${kind}`), index]);
  add(home, "small", "", "sees");
  for (const name of SECTORS) add(home, "small", "top", name);
  OBJECTS.forEach((name, colour) => {
    add(home, "small", "", title(name));
    for (const sector of [0, 1, 2]) lamp(home, 2 + 3 * sector + colour, name);
  });
  const row = (name) => {
    const made = add(home, "div", "row");
    add(made, "small", "", name);
    return made;
  };
  const feels = row("feels");
  [["right side", 0], ["left side", 1]].forEach(([name, index]) => {
    const span = add(feels, "span");
    lamp(span, index);
    add(span, "small", "", name);
  });
  const bend = row("forearm bent");
  all.push([add(add(bend, "span", "bar"), "b"), 11]);
  const hears = row("hears");
  for (const first of [15, 12]) {
    const span = add(hears, "span");
    for (let k = 0; k < 3; k++) lamp(span, first + k);
  }
  return all;
}

/** Four dots that move along their scales. */
function motors(home) {
  home.replaceChildren();
  return MOTORS.map(([joint, low, high]) => {
    if (joint) add(home, "small", "joint", joint);
    const meter = add(home, "div", "meter");
    add(meter, "small", "", low);
    const dot = add(add(meter, "div", "scale"), "b");
    add(meter, "small", "", high);
    return dot;
  });
}

/** Everything that a state says, but for senses and traces. */
export function show(state) {
  const [action, object] = state.words;
  for (const [name, word] of [["action", action], ["object", object]]) {
    const input = document.querySelector(`input[name=${name}][value=${word}]`);
    if (input) input.checked = true;
  }
  part("badge").replaceChildren();
  if (state.met) part("badge").textContent = "Met during evolution.";
  else add(part("badge"), "b", "", "never met during evolution");
  const run = part("run");
  const going = state.phase === "running" && !state.paused;
  run.textContent = going ? "Pause" : state.phase === "running" ? "Go on" : state.phase === "ended" ? "Once more" : "Start";
  part("speed").value = String(state.speed);
  part("loop-note").textContent = NOTES[state.closed ? "closed" : "open"];
  part("loop").value = state.closed ? "closed" : "open";
  part("area").value = state.area;
  if (document.activeElement !== part("seed")) part("seed").value = state.seed;
  verdict(state);
}

function verdict(state) {
  const [action, object] = state.words;
  const box = part("verdict");
  box.className = `verdict ${object.toLowerCase()}`;
  part("ring").style.strokeDasharray = `${100 * state.share} 200`;
  const order = `${action} ${title(object)}`;
  const asked = action === "MOVE" ? "turn the object by 34°" : "ten seconds on end";
  const now = state.fault ? `Broken off: ${state.fault}`
    : state.phase === "ready" ? `Ready to ${order}: ${asked}.`
    : state.phase === "ended" ? `${order} is over. Say other words, and it goes on from here.`
    : `${order}: ${Math.round(100 * state.share)} % done (${asked}).`;
  if (part("now").textContent !== now) part("now").textContent = now;
  const lines = [];
  if (state.robot) lines.push(["Robot", state.robot.success, state.robot.success ? "carried out" : `not carried out: ${state.robot.reason}`]);
  if (state.planar !== null) lines.push(["Planar arm", state.planar, state.planar ? "carried out" : "not carried out"]);
  const key = JSON.stringify(lines);
  if (part("judges").dataset.key === key) return;
  part("judges").dataset.key = key;
  part("judges").replaceChildren();
  for (const [who, success, words] of lines) {
    add(part("judges"), "span", success ? "yes" : "no", `${success ? "✓" : "✕"} ${who}: ${words}`);
  }
}
