// What is said of a trial, in words.

import { inView } from "../world/camera.js";
import { NONE } from "../world/contact.js";
import { IGNORE, INDICATE, MOVE, TOUCH, full, scores, share } from "../world/judge.js";
import { OBJECTS, neverMet, spoken } from "../world/words.js";
import { DT, GOOD_STEPS_FOR_SUCCESS } from "../world/world.js";

const HOLD = `${GOOD_STEPS_FOR_SUCCESS * DT} seconds`;

/** What an instruction asks for. */
export function meaning(world, instruction) {
  const object = OBJECTS[instruction.object];
  const text = {
    [MOVE]: `push ${object} along by ${world.moveAngle.toFixed(0)} degrees, with the right side of the forearm.`,
    [TOUCH]: `point at ${object}, lay the right side of the forearm against it and keep still for ${HOLD}.`,
    [INDICATE]: `point the upper arm at ${object} for ${HOLD}, without touching it.`,
    [IGNORE]: `keep ${object} out of sight and out of touch for ${HOLD}.`,
  }[instruction.action];
  const never = neverMet(instruction) ? " It never met these two words together." : "";
  return `${spoken(instruction)}: ${text}${never}`;
}

/** { kind, text } of a state: what the trial has come to. Kinds: start, search, sight, hold, yes, no. */
export function verdict(world, state, first) {
  const { judged } = state;
  if (judged.done) return ending(world, state);
  const object = OBJECTS[judged.object];
  if (first) return { kind: "start", text: `Ready to ${spoken(judged)}.` };
  if (judged.good) return { kind: "hold", text: doing(judged.action, object, state.turned !== 0) };
  if (judged.action === IGNORE) return { kind: "search", text: `Not yet away from ${object}.` };
  if (inView(world, state.alpha, state.discs[judged.object])) return { kind: "sight", text: `It sees ${object}.` };
  return { kind: "search", text: `It looks for ${object}.` };
}

/** How much of the action is done, from 0 to 1. */
export function progress(world, state) {
  const { judged } = state;
  if (judged.done) return scores(world, state).success ? 1 : 0;
  return Math.min(1, Math.abs(judged.run) / full(world, judged.action));
}

function doing(action, object, turns) {
  return {
    [MOVE]: turns ? `It pushes ${object}.` : `It leans against ${object}.`,
    [TOUCH]: `It holds still against ${object}.`,
    [INDICATE]: `It points at ${object}.`,
    [IGNORE]: `It stays away from ${object}.`,
  }[action];
}

function ending(world, state) {
  const { judged } = state;
  const after = `${(judged.steps * DT).toFixed(1)} s`;
  if (scores(world, state).success) return { kind: "yes", text: `Done: ${spoken(judged)} carried out in ${after}.` };
  return { kind: "no", text: `Not done: ${reason(world, state)} (${spoken(judged)}, ${after}).` };
}

function reason(world, state) {
  const { judged } = state;
  const knocked = state.discs.findIndex((disc, k) => k !== judged.object && disc.side !== NONE && !judged.excused[k]);
  if (judged.collided && knocked >= 0) return `it ran into ${OBJECTS[knocked]}`;
  if (share(world, judged) < 1.0) return "time is up";
  if (judged.action === IGNORE) return `it stayed away, but had ${OBJECTS[judged.object]} in view in the end`;
  if (scores(world, state).f1 < 1.0) return "it did the action, but ended off the object";
  return "it did the action, but with a bent forearm";
}
