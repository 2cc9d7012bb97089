// A session shown: the table, the panels, the verdict and the time, at a place between two of its states.

import { look } from "../world/camera.js";
import { sense } from "../world/trial.js";
import { DT, MAX_STEPS } from "../world/world.js";
import { between, joints } from "./geometry.js";
import { last } from "./session.js";
import { set, write } from "./svg.js";
import { meaning, progress, verdict } from "./verdict.js";

// How many past places of the forearm's end are shown.
const TRAIL = 30;
// A passing remark stands at least so long [ms].
const REMARK = 500;

/** Whether the trial is over and seen to its end. */
export function atEnd({ session, place }) {
  return last(session).judged.done && place >= session.states.length - 1;
}

/** The words that are heard from state `k` on. */
export function heardAt({ session }, k) {
  return k < session.states.length - 1 ? session.states[k + 1].heard : session.instruction;
}

/** Show the session at its place. */
export function show(player) {
  const { session, place, find, clock } = player;
  const { states, world, silenced } = session;
  const before = Math.floor(place);
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
  showTime(find, states.length - 1, place);
  write(find("play-text"), clock.runs ? "Pause" : atEnd(player) ? "Again" : "Play");
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
