// How often an agent carries out each of its nine instructions, from fresh starts of both sides.

import { scores } from "./judge.js";
import { decode } from "./network.js";
import { drawStart, generator } from "./starts.js";
import { begin, creature, step } from "./trial.js";
import { instructionsOf } from "./words.js";
import { worldOf } from "./world.js";

/** Trials of each instruction from each start area: 80 in all, as in the paper. */
export const PER_AREA = 40;

/** Run one trial to its end and return its last state. */
export function runTrial(agent, start, instruction) {
  let state = begin(agent, start, instruction);
  while (!state.judged.done) state = step(agent, state, instruction);
  return state;
}

/**
 * Successes of each instruction, one after the other.
 *
 * @param order { genotype, readings, condition, silenced, seed }, plain values that a worker can be sent.
 */
export function* census({ genotype, readings, condition, silenced, seed }) {
  const world = worldOf(readings);
  const agent = creature(decode(genotype, readings), world, silenced);
  const draw = generator(seed);
  for (const instruction of instructionsOf(condition)) {
    let successes = 0;
    for (let trial = 0; trial < 2 * PER_AREA; trial++) {
      const start = drawStart(world, trial < PER_AREA ? 0 : 1, draw);
      if (scores(world, runTrial(agent, start, instruction)).success) successes += 1;
    }
    yield { instruction, successes };
  }
}
