// The map of successes, counted in a worker when the reader asks for it.

import { makeMap, TRIALS } from "./heatmap.js";
import { instructionsOf, neverMet, spoken } from "../world/words.js";
import { set, write } from "./svg.js";
import { count } from "./worker.js";

/** The counting part of a player; `onChoose(instruction)` is called where a cell of the map is chosen. */
export function makeCensus(player, script, onChoose) {
  const { find } = player;
  const census = { counts: null, map: null, seed: 0, order: 0 };
  const paint = () => census.map.show(census.counts, player.session.agent.successes);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", paint);
  find("count").addEventListener("click", () => run(player, census, script, paint));
  return {
    /** Nothing is counted yet, of this agent with what of it is silenced. */
    forget() {
      census.counts = null;
      census.order += 1;
      find("count").disabled = false;
      const { agent, silenced } = player.session;
      census.map = makeMap(find("map"), agent.condition, onChoose);
      write(find("census-lead"), leadOf(silenced, false));
      write(find("tally"), "");
      paint();
    },
    mark: (instruction) => census.map.mark(instruction),
  };
}

/** Count anew, from other starts than the last time. */
async function run(player, census, script, paint) {
  const { find, session } = player;
  const order = (census.order += 1);
  const { agent, silenced } = session;
  const began = performance.now();
  census.counts = [];
  census.seed += 1;
  find("count").disabled = true;
  set(find("map"), { "aria-busy": true });
  write(find("census-lead"), leadOf(silenced, true));
  write(find("tally"), "Counting …");
  paint();
  const { genotype, readings, condition } = agent;
  try {
    await count(script, { genotype, readings, condition, silenced, seed: census.seed }, ({ successes }) => {
      if (order !== census.order) return; // another agent has sat down meanwhile
      census.counts.push(successes);
      paint();
    });
    if (order === census.order) write(find("tally"), tally(condition, census.counts, performance.now() - began));
  } catch (error) {
    write(find("tally"), `Not counted: ${error.message}.`);
  }
  set(find("map"), { "aria-busy": false });
  if (order === census.order) find("count").disabled = false;
}

function leadOf({ action, object, neurons }, counted) {
  const mute = [action && "the action word", object && "the object word", ...neurons.map((each, k) => each && `neuron ${k + 1}`)];
  const names = mute.filter(Boolean);
  const silenced = names.length ? ` Silenced in yours: ${names.join(", ")}.` : "";
  const whose = counted ? "Yours stand large, ours below, from other starts." : "These are our counts.";
  return `Forty starts from the right, forty from the left, objects anywhere on their lines. ${whose}${silenced}`;
}

function tally(condition, counts, milliseconds) {
  const total = counts.reduce((sum, each) => sum + each, 0);
  const unknown = instructionsOf(condition)
    .map((instruction, k) => neverMet(instruction) && `${spoken(instruction)} ${counts[k]} of ${TRIALS}`)
    .filter(Boolean);
  const seconds = (milliseconds / 1000).toFixed(1);
  return `${total} of ${TRIALS * counts.length} tries carried out, counted in ${seconds} s. Never practised: ${unknown.join(", ")}.`;
}
