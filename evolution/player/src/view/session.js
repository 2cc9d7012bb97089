// What the reader does with an agent: a trial that can be stepped, rewound and changed at any moment.
// A change drops the states that lay ahead; the trial goes on from the one it was made in.

import { placeAt } from "../world/contact.js";
import { judgement } from "../world/judge.js";
import { INTACT, decode, outputs } from "../world/network.js";
import { begin, creature, step } from "../world/trial.js";
import { actionsOf } from "../world/words.js";
import { worldOf } from "../world/world.js";

/** A session with an agent { condition, readings, genotype }, about to obey `instruction` from `start`. */
export function open(agent, start, instruction, silenced = INTACT) {
  const world = worldOf(agent.readings);
  const session = { agent, network: decode(agent.genotype, agent.readings), world, start, instruction, silenced };
  return rewound(session);
}

/** The session at the start of its trial, whatever had happened. */
export function rewound(session) {
  const states = [begin(creatureOf(session), session.start, session.instruction)];
  return { ...session, states };
}

/** The session with the state number `k` computed, or the last one before it if the trial ends earlier. */
export function advanced(session, k) {
  const { states } = session;
  const self = creatureOf(session);
  while (states.length <= k && !last(session).judged.done) {
    states.push(step(self, last(session), session.instruction));
  }
  return session;
}

/** The last state computed. */
export function last({ states }) {
  return states[states.length - 1];
}

/** Say other words in state `k`. From there on they are judged anew. */
export function told(session, k, instruction) {
  if (k === 0) return rewound({ ...session, instruction });
  const state = session.states[k];
  const excused = state.discs.map((disc) => disc.side !== 0);
  const judged = judgement(instruction, state.alpha, state.discs, excused);
  return cut({ ...session, instruction }, k, { ...state, judged });
}

/** Put an object at `centre` [x, y] cm in state `k`. */
export function moved(session, k, object, centre) {
  const replace = (all, one) => all.map((each, index) => (index === object ? one : each));
  if (k === 0) {
    return rewound({ ...session, start: { ...session.start, centres: replace(session.start.centres, centre) } });
  }
  const state = session.states[k];
  const discs = replace(state.discs, placeAt(session.world, centre));
  return cut(session, k, { ...state, discs, fresh: true, judged: resumed(state.judged) });
}

/** Silence words or neurons from state `k` on: { action, object, neurons }. */
export function muted(session, k, silenced) {
  if (k === 0) return rewound({ ...session, silenced });
  const state = session.states[k];
  const z = outputs(session.network, state.y, silenced);
  return cut({ ...session, silenced }, k, { ...state, z, judged: resumed(state.judged) });
}

/** The instruction for another condition: its third action takes the place of this one's. */
export function translated(instruction, condition) {
  const known = actionsOf(condition);
  return known.includes(instruction.action) ? instruction : { ...instruction, action: known[2] };
}

function creatureOf({ network, world, silenced }) {
  return creature(network, world, silenced);
}

/** The session up to state `k`, which becomes `state`. */
function cut(session, k, state) {
  return { ...session, states: [...session.states.slice(0, k), state] };
}

/** A judgement that goes on: what has ended a trial no longer holds after the reader's hand. */
function resumed(judged) {
  return judged.done ? { ...judged, done: false, collided: false, run: 0.0, best: 0.0, steps: 0 } : judged;
}
