// One trial, state by state: sense, think, turn, touch, judge (arm2d/kernel/loop.py). A state is a plain
// record that is never changed, so that a trial can be stepped back, or continued with other words.

import { look } from "./camera.js";
import { LEFT, RIGHT, placeAt, touchDiscs } from "./contact.js";
import { judge, judgement } from "./judge.js";
import { INTACT, motorInputs, outputs, think, turnJoints } from "./network.js";
import { hear } from "./words.js";
import { BETA_MAX } from "./world.js";

/** An agent in its world: network, world, and what of it is silenced. */
export function creature(network, world, silenced = INTACT) {
  return { network, world, silenced };
}

/** The state in which a trial begins: S1 at `alpha` [deg], S2 fully bent, discs at `centres` [[x, y], ...]. */
export function begin({ network, world, silenced }, { alpha, centres }, instruction) {
  const y = [0.0, 0.0, 0.0];
  const discs = centres.map((centre) => placeAt(world, centre));
  return {
    alpha,
    beta: BETA_MAX,
    turned: 0.0,
    bent: 0.0,
    discs,
    fresh: true,
    y,
    z: outputs(network, y, silenced),
    heard: instruction,
    judged: judgement(instruction, alpha, discs),
  };
}

/** What the agent senses in a state: I1 to I18. */
export function sense({ world, silenced }, state, heard) {
  const touches = [RIGHT, LEFT].map((side) => (state.discs.some((disc) => disc.side === side) ? 1 : 0));
  return [...touches, ...look(world, state.alpha, state.discs), state.beta / BETA_MAX, ...hear(heard, silenced)];
}

/** The state a tenth of a second later, hearing `heard`; with the inputs and motors that led to it. */
export function step(agent, state, heard) {
  const { network, world, silenced } = agent;
  const inputs = sense(agent, state, heard);
  const y = think(network, state.y, state.z, inputs);
  const z = outputs(network, y, silenced);
  const motors = motorInputs(network, z);
  const [alpha, beta] = turnJoints(motors, state.alpha, state.beta, world.turn);
  const arm = { alpha, beta, turned: alpha - state.alpha, bent: beta - state.beta };
  const next = { ...arm, discs: touchDiscs(world, state, arm), fresh: false, y, z, inputs, motors, heard };
  return { ...next, judged: judge(world, state.judged, next) };
}
