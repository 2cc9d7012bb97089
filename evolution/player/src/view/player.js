// The player: the reader's hand on a session, and a session shown.

import { look } from "../world/camera.js";
import { makeClock } from "./clock.js";
import { makeCensus } from "./counting.js";
import { between, joints } from "./geometry.js";
import { makeMind, makeMotors, makeSenses } from "./panels.js";
import { advanced, last, moved, muted, open, rewound, told, translated } from "./session.js";
import { keepLetters, makeStage } from "./stage.js";
import { drawStart, generator } from "../world/starts.js";
import { set, write } from "./svg.js";
import { sense } from "../world/trial.js";
import { meaning, progress, verdict } from "./verdict.js";
import { makeWords } from "./words_panel.js";
import { DT, MAX_STEPS } from "../world/world.js";

// How many past places of the forearm's end are shown.
const TRAIL = 30;
// A passing remark stands at least so long [ms].
const REMARK = 500;
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

/** Whether the trial is over and seen to its end. */
function atEnd({ session, place }) {
  return last(session).judged.done && place >= session.states.length - 1;
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

/** The words that are heard from state `k` on. */
function heardAt({ session }, k) {
  return k < session.states.length - 1 ? session.states[k + 1].heard : session.instruction;
}

/** Show the session at its place. */
function show(player) {
  const { session, place, find, clock } = player;
  const { states, world, silenced } = session;
  const [before, after] = [Math.floor(place), Math.ceil(place)];
  const state = states[before];
  const heard = heardAt(player, before);
  const said = verdict(world, state, before === 0);
  const lit = !state.judged.done;
  player.stage.show({ ...sceneOf(session, place, said), heard, silenced, lit });
  player.words(heard, silenced, lit);
  player.senses(sense(session, state, heard));
  player.mind(states, place, silenced);
  player.motors(state);
  player.census.mark(heard);
  write(find("meaning"), meaning(world, heard));
  remark(player, said);
  showTime(find, states.length - 1, after === before ? before : place);
  write(find("play-text"), clock.runs ? "Pause" : atEnd(player) ? "Again" : "Play");
  set(find("play"), { "aria-pressed": clock.runs });
  showStart(find, session.start.alpha);
}

function showStart(find, alpha) {
  if (document.activeElement !== find("start")) find("start").value = alpha;
  const away = Math.round(alpha - 90);
  const text = away === 0 ? "straight ahead" : `${Math.abs(away)}° to the ${away > 0 ? "left" : "right"}`;
  write(find("start-text"), text);
  set(find("start"), { "aria-valuetext": text });
}

/** What the stage shows. */
function sceneOf({ states, world }, place, said) {
  const [before, after] = [Math.floor(place), Math.ceil(place)];
  const [state, next] = [states[before], states[after]];
  const now = between(state, next, place - before);
  const sight = look(world, state.alpha, state.discs);
  const past = states.slice(Math.max(0, before - TRAIL), before + 1);
  return {
    ...now,
    sides: next.discs.map((disc) => disc.side),
    sees: [0, 1, 2].map((sector) => sight.slice(3 * sector, 3 * sector + 3).includes(1)),
    target: state.judged.object,
    progress: progress(world, state),
    kind: said.kind,
    trail: [...past, now].map(({ alpha, beta }) => joints(alpha, beta).tip),
  };
}

/** Say what the trial has come to; passing remarks are not changed faster than they can be read. */
function remark(player, { kind, text }) {
  const passing = kind !== "yes" && kind !== "no" && kind !== "start";
  const now = performance.now();
  if (player.clock.runs && passing && now - player.remarked < REMARK) return;
  const place = player.find("verdict");
  if (place.textContent !== text) player.remarked = now;
  write(place, text);
  set(place, { "data-kind": kind });
}

function showTime(find, n, place) {
  const time = find("time");
  set(time, { max: Math.max(MAX_STEPS, n), "aria-valuetext": `${(place * DT).toFixed(1)} seconds` });
  time.value = place;
  time.style.setProperty("--known", `${(100 * n) / Math.max(MAX_STEPS, n)}%`);
  write(find("clock"), `${(place * DT).toFixed(1)} s`);
}
