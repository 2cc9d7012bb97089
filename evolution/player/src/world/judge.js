// How well an instruction is carried out, step by step and in the end; as arm2d/kernel/scores.py.

import { inView, offsetOf } from "./camera.js";
import { NONE, RIGHT } from "./contact.js";
import { BETA_MAX, COLLISION_FACTOR, GOOD_STEPS_FOR_SUCCESS, MAX_STEPS, THRESHOLD_TOLERANCE } from "./world.js";

export const MOVE = 0;
export const TOUCH = 1;
export const INDICATE = 2;
export const IGNORE = 3;

/**
 * A fresh judgement of an instruction.
 *
 * `excused` are objects that the arm already touches when the words change in mid-trial: they count as
 * knocked only when they were let go and are touched again.
 */
export function judgement(instruction, alpha, discs, excused = [false, false, false]) {
  const firstOffset = offsetOf(alpha, discs[instruction.object]);
  return { ...instruction, firstOffset, excused, run: 0.0, best: 0.0, stretch: 0.0, steps: 0, collided: false, done: false };
}

/** The judgement after a step that has led to `state` (its arm and discs). */
export function judge(world, before, state) {
  const target = state.discs[before.object];
  const seen = inView(world, state.alpha, target);
  const good = isGood(world, before.action, offsetOf(state.alpha, target), seen, target.side, state.turned);
  const gain = before.action === MOVE ? state.turned : 1.0;
  const run = good ? before.run + gain : before.run * world.keep;
  const best = Math.max(before.best, Math.abs(run));
  const stretch = seen ? Math.max(before.stretch, 1.0 - state.beta / BETA_MAX) : before.stretch;
  const excused = before.excused.map((each, disc) => each && state.discs[disc].side !== NONE);
  const collided = state.discs.some((disc, k) => k !== before.object && disc.side !== NONE && !excused[k]);
  const steps = before.steps + 1;
  const done = best >= goal(world, before.action) - THRESHOLD_TOLERANCE || collided || steps >= MAX_STEPS;
  return { ...before, excused, run, best, stretch, steps, collided, done, good };
}

/** Whether a step counts. */
function isGood(world, action, offset, seen, side, turned) {
  if (action === INDICATE) return offset < world.indicateCone && side === NONE;
  if (action === IGNORE) return !seen && side === NONE;
  const held = offset < world.targetCone && side === RIGHT;
  return action === MOVE ? held : held && turned === 0.0;
}

/** The run of good steps, or of turns [deg], that ends the trial. */
export function goal(world, action) {
  if (action === IGNORE && !world.ignoreStops) return Infinity;
  return full(world, action);
}

/** The run that earns the whole of F2. */
export function full(world, action) {
  return action === MOVE ? world.moveAngle : GOOD_STEPS_FOR_SUCCESS;
}

/** How much of the action is done, from 0 to 1. */
export function share(world, judged) {
  const whole = full(world, judged.action);
  return judged.best >= whole - THRESHOLD_TOLERANCE ? 1.0 : judged.best / whole;
}

/** { f1, f2, f3, success }: found the object, did the action, stretched the forearm. */
export function scores(world, state) {
  const judged = state.judged;
  const target = state.discs[judged.object];
  const seen = inView(world, state.alpha, target);
  const f1 = found(world, judged, offsetOf(state.alpha, target), seen);
  const f2 = f1 === 1.0 ? share(world, judged) : 0.0;
  const stretches = judged.action === TOUCH || judged.action === MOVE;
  const atEnd = seen ? 1.0 - state.beta / BETA_MAX : 0.0;
  const f3 = !stretches ? 0.0 : world.bestStretch ? judged.stretch : atEnd;
  const strict = world.strictSuccess && stretches;
  return { f1, f2, f3, success: f1 === 1.0 && f2 === 1.0 && (!strict || f3 > 0.99) };
}

/** F1: how much nearer S1 has come to the target, 1 on target; for IGNORE whether it is out of view. */
function found(world, judged, offset, seen) {
  if (judged.action === IGNORE) return seen ? 0.0 : 1.0;
  const penalty = judged.collided ? COLLISION_FACTOR : 1.0;
  const ratio = judged.firstOffset > 0.0 ? (judged.firstOffset - offset) / judged.firstOffset : 0.0;
  const onTarget = offset < world.targetCone ? 1.0 : 0.0;
  if (world.wholePenalty) return penalty * Math.max(0.0, ratio, onTarget);
  return Math.max(0.0, ratio * penalty, onTarget);
}
