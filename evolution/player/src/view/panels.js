// What goes on inside: 18 senses, three neurons, four motors.

import { sigmoid } from "../world/arithmetic.js";
import { html, set, svg, write } from "./svg.js";
import { OBJECTS } from "../world/words.js";
import { DT, MAX_STEPS } from "../world/world.js";

const SECTORS = ["right", "middle", "left"];

/** The 18 inputs, in the order in which the agent has them. */
export const INPUT_NAMES = [
  "touch on the forearm's right side",
  "touch on the forearm's left side",
  ...SECTORS.flatMap((sector) => OBJECTS.map((object) => `${object} seen ${where(sector)}`)),
  "how far the forearm is bent",
  ...[1, 2, 3].map((place) => `object word, sound ${place}`),
  ...[1, 2, 3].map((place) => `action word, sound ${place}`),
];

function where(sector) {
  return sector === "middle" ? "in the middle" : `on the ${sector}`;
}

/** Lamps for all inputs; `show(inputs)` lights them. */
export function makeSenses(panel) {
  const lamps = [];
  const lamp = (parent, input, extra = "") => {
    lamps[input] = html(parent, "i", { class: `wa-lamp ${extra}`, title: INPUT_NAMES[input] });
  };
  const grid = html(group(panel, "sees", "wa-sees"), "div", { class: "wa-grid" });
  ["", "left", "middle", "right"].forEach((head) => html(grid, "small", {}, head));
  OBJECTS.forEach((object, k) => {
    html(grid, "small", {}, object);
    [2, 1, 0].forEach((sector) => lamp(grid, 2 + 3 * sector + k, `wa-${object.toLowerCase()}`));
  });
  const feels = html(group(panel, "feels", ""), "div", { class: "wa-line" });
  [["left", 1], ["right", 0]].forEach(([side, input]) => {
    const cell = html(feels, "span");
    lamp(cell, input);
    html(cell, "small", {}, `${side} side`);
  });
  const bent = group(panel, "bent", "");
  const bar = html(html(bent, "span", { class: "wa-bar", title: INPUT_NAMES[11] }), "b");
  const hears = group(panel, "hears", "");
  [["object word", 12], ["action word", 15]].forEach(([name, first]) => {
    const line = html(hears, "div", { class: "wa-line" });
    [0, 1, 2].forEach((k) => lamp(line, first + k));
    html(line, "small", {}, name);
  });
  return (inputs) => {
    lamps.forEach((each, input) => each.classList.toggle("wa-on", inputs[input] === 1));
    bar.style.width = `${(100 * inputs[11]).toFixed(1)}%`;
    set(panel, { "aria-label": `What it senses: ${sensed(inputs)}` });
  };
}

function sensed(inputs) {
  const on = INPUT_NAMES.filter((_, k) => k !== 11 && k < 12 && inputs[k] === 1);
  return `${on.length ? on.join(", ") : "nothing seen or touched"}; forearm bent ${Math.round(90 * inputs[11])} degrees`;
}

function group(panel, name, extra) {
  const block = html(panel, "div", { class: `wa-group ${extra}` });
  html(block, "h4", {}, name);
  return block;
}

/** Curves of the three neurons over time; `show(states, place)` draws them, `onMute(k)` silences one. */
export function makeMind(host, onMute) {
  const rows = [0, 1, 2].map((k) => makeTrace(host, k, () => onMute(k)));
  const axis = html(host, "div", { class: "wa-axis", "aria-hidden": "true" });
  const ends = ["0 s", ""].map((text) => html(axis, "small", {}, text));
  let drawn = null;
  return (states, place, silenced) => {
    const span = Math.max(MAX_STEPS, states.length - 1);
    const fresh = drawn?.states !== states || drawn.length !== states.length;
    if (fresh) drawn = { states, length: states.length };
    write(ends[1], `${(span * DT).toFixed(0)} s`);
    rows.forEach((row, k) => row(states, place, span, silenced.neurons[k], fresh));
  };
}

function makeTrace(host, k, onMute) {
  const line = html(host, "div", { class: "wa-trace" });
  const side = html(line, "div");
  html(side, "h4", {}, `neuron ${k + 1}`);
  const button = html(side, "button", { type: "button", class: "wa-mute", "aria-pressed": "false" }, "silence");
  set(button, { "aria-label": `silence neuron ${k + 1}` });
  button.addEventListener("click", onMute);
  const chart = svg(line, "svg", { viewBox: "0 0 250 40", preserveAspectRatio: "none", role: "img" });
  const marks = svg(chart, "path", { class: "wa-marks" });
  const curve = svg(chart, "path", { class: "wa-curve" });
  const cursor = svg(chart, "path", { class: "wa-cursor" });
  return (states, place, span, silenced, fresh) => {
    const x = (step) => ((250 * step) / span).toFixed(1);
    const height = (state) => (38 - 36 * state.z[k]).toFixed(1);
    if (fresh) {
      set(curve, { d: `M${states.map((state, step) => `${x(step)} ${height(state)}`).join("L")}` });
      const changes = states.flatMap((state, step) => (step > 1 && state.heard !== states[step - 1].heard ? [step - 1] : []));
      set(marks, { d: `M0 20H250${changes.map((step) => `M${x(step)} 0V40`).join("")}` });
    }
    set(cursor, { d: `M${x(place)} 0V40` });
    set(button, { "aria-pressed": silenced });
    line.classList.toggle("wa-silent", silenced);
    const now = states[Math.min(Math.floor(place), states.length - 1)].z[k];
    set(chart, { "aria-label": `Neuron ${k + 1}: ${now.toFixed(2)} of 1` });
  };
}

// For each joint: its name, what a quiet second motor (below half) makes it do, and a loud one.
const MOTORS = [
  ["upper arm", "turns left", "turns right"],
  ["forearm", "bends", "stretches"],
];

/** Meters of the four motors; `show(state)` moves them. */
export function makeMotors(panel) {
  const meters = [];
  const says = MOTORS.map(([joint, low, high]) => {
    const block = group(panel, joint, "wa-joint-block");
    const text = html(block, "p", { class: "wa-does" });
    meters.push(meter(block, "rest", "go"), meter(block, low, high));
    return text;
  });
  return ({ motors, turned, bent }) => {
    const outputs = motors ? motors.map(sigmoid) : [0, 0.5, 0, 0.5];
    meters.forEach((each, k) => (each.style.left = `${(100 * outputs[k]).toFixed(1)}%`));
    const does = [turned, bent].map((turn, joint) => doing(MOTORS[joint], turn, outputs[2 * joint]));
    says.forEach((text, joint) => write(text, does[joint]));
    set(panel, { "aria-label": `What it does: the upper arm ${does[0]}, the forearm ${does[1]}` });
  };
}

function doing([, low, high], turn, go) {
  if (turn !== 0) return turn > 0 ? low : high;
  return go > 0.5 ? "is at its stop" : "rests";
}

function meter(parent, low, high) {
  const row = html(parent, "div", { class: "wa-meter" });
  html(row, "small", {}, low);
  const needle = html(html(row, "span", { class: "wa-scale" }), "b");
  html(row, "small", {}, high);
  return needle;
}
