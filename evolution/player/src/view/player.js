// The reader's hand on a session: everything that can be pressed, dragged or typed.

import { drawStart, generator } from "../world/starts.js";
import { makeClock } from "./clock.js";
import { makeCensus } from "./counting.js";
import { makeMind, makeMotors, makeSenses } from "./panels.js";
import { advanced, moved, muted, open, rewound, told, translated } from "./session.js";
import { atEnd, heardAt, show } from "./showing.js";
import { keepLetters, makeStage } from "./stage.js";
import { write } from "./svg.js";
import { makeWords } from "./words_panel.js";

const FIRST_INSTRUCTION = { action: 1, object: 2 };
const FIRST_SEED = 11;

/** Bring an element of the page to life, for agents { name, note, condition, readings, genotype, successes }. */
export function makePlayer(root, agents, script) {
  const find = (part) => root.querySelector(`[data-part="${part}"]`);
  const player = { root, find, agents, draw: generator(FIRST_SEED), area: 0, place: 0, remarked: 0 };
  player.clock = makeClock(
    () => Number(find("speed").value),
    (steps) => proceed(player, steps),
  );
  player.census = makeCensus(player, script, (instruction) => {
    newStart(player);
    restart(player, told(player.session, 0, instruction));
    play(player);
  });
  agents.forEach(({ name }, k) => find("agent").add(new Option(name, k)));
  player.senses = makeSenses(find("senses"));
  player.motors = makeMotors(find("motors"));
  player.mind = makeMind(find("mind"), (k) => silence(player, { neurons: flipped(player.session.silenced.neurons, k) }));
  keepLetters(find("stage"));
  listen(player);
  useAgent(player, 0);
  return player;
}

/** Put an agent into the chair: its words, its world, its counts. */
function useAgent(player, index) {
  const agent = player.agents[index];
  const instruction = translated(player.session?.instruction ?? FIRST_INSTRUCTION, agent.condition);
  const session = open(agent, { alpha: 0, centres: [[150, 0], [0, 150], [-150, 0]] }, instruction);
  player.session = session;
  newStart(player);
  player.stage = makeStage(player.find("stage"), session.world, (object, centre) =>
    change(player, moved(player.session, nextState(player), object, centre)),
  );
  player.words = makeWords(player.find, agent.condition, (part) => {
    const k = nextState(player);
    change(player, told(player.session, k, { ...heardAt(player, k), ...part }));
    play(player);
  });
  write(player.find("agent-note"), agent.note);
  player.census.forget();
  restart(player, player.session);
}

/** Everything a reader can press, drag or type. */
function listen(player) {
  const { find } = player;
  const on = (part, event, act) => find(part).addEventListener(event, act);
  on("play", "click", () => (player.clock.runs ? pause(player) : play(player)));
  on("restart", "click", () => restart(player, rewound(player.session)));
  on("back", "click", () => goTo(player, Math.ceil(player.place) - 1));
  on("forward", "click", () => goTo(player, Math.floor(player.place) + 1));
  on("time", "input", () => goTo(player, Number(find("time").value)));
  on("agent", "change", () => useAgent(player, Number(find("agent").value)));
  on("shuffle", "click", () => {
    newStart(player);
    restart(player, player.session);
  });
  on("start", "input", () => {
    const start = { ...player.session.start, alpha: Number(find("start").value) };
    restart(player, rewound({ ...player.session, start }));
  });
  for (const word of ["action", "object"]) {
    on(`mute-${word}`, "click", () => silence(player, { [word]: !player.session.silenced[word] }));
  }
  player.root.querySelector(".wa-stage").addEventListener("keydown", (event) => key(player, event));
}

/** Keys while the table has the focus. */
function key(player, event) {
  if (event.altKey || event.ctrlKey || event.metaKey) return;
  const { find } = player;
  const third = player.session.agent.condition === "with-ignore" ? 3 : 2;
  const say = (part, code) => find(part).querySelector(`input[value="${code}"]`).click();
  const acts = {
    " ": () => find("play").click(),
    ArrowLeft: () => find("back").click(),
    ArrowRight: () => find("forward").click(),
    Home: () => find("restart").click(),
    m: () => say("actions", 0),
    t: () => say("actions", 1),
    i: () => say("actions", third),
    b: () => say("objects", 0),
    g: () => say("objects", 1),
    r: () => say("objects", 2),
  };
  const act = acts[event.key] ?? acts[event.key.toLowerCase()];
  if (!act) return;
  event.preventDefault();
  act();
}

function play(player) {
  if (atEnd(player)) restart(player, rewound(player.session));
  player.clock.start();
  show(player);
}

function pause(player) {
  goTo(player, Math.ceil(player.place));
}

/** Let the time pass. */
function proceed(player, steps) {
  const place = player.place + steps;
  advanced(player.session, Math.ceil(place));
  player.place = Math.min(place, player.session.states.length - 1);
  if (atEnd(player)) player.clock.stop();
  show(player);
}

/** Stand still at a step. */
function goTo(player, step) {
  player.clock.stop();
  advanced(player.session, step);
  player.place = Math.max(0, Math.min(step, player.session.states.length - 1));
  show(player);
}

/** The state that a change falls into: the one the arm is just reaching. */
function nextState({ session, place }) {
  return Math.min(Math.ceil(place), session.states.length - 1);
}

/** A session that was changed at the present place. */
function change(player, session) {
  player.place = Math.min(player.place, session.states.length - 1);
  player.session = session;
  show(player);
}

function restart(player, session) {
  player.clock.stop();
  player.place = 0;
  player.session = session;
  show(player);
}

function silence(player, part) {
  const silenced = { ...player.session.silenced, ...part };
  change(player, muted(player.session, nextState(player), silenced));
  player.census.forget();
}

function flipped(neurons, k) {
  return neurons.map((each, index) => (index === k ? !each : each));
}

/** Draw another start, from the other side than the last. */
function newStart(player) {
  const start = drawStart(player.session.world, player.area, player.draw);
  player.area = 1 - player.area;
  player.session = rewound({ ...player.session, start });
}
