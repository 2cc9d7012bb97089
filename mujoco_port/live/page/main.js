// The page: what is heard from the robot is shown, what the reader does is asked for.

import { context, draw, drawing } from "./drawing.js";
import { hand } from "./hand.js";
import { link } from "./link.js";
import { insides, show, words } from "./panels.js";
import { OBJECTS, alike, between, readMoment, readScene } from "./scene.js";
import { drawTraces } from "./traces.js";
import { eye, inPicture, jump, looking } from "./view.js";

const PERIOD_MS = 40;
// A picture that takes longer is drawn with fewer pixels, at last without shadows.
const SLOW_MS = 45;
const FINENESS = [2, 1.5, 1, 0.75, 0.6, 0.45];
const SOFTWARE_FROM = 3;
const TRIED = 12;
// What has not moved for so long is drawn once as finely as the screen shows it.
const STILL_MS = 300;

const part = (id) => document.getElementById(id);
const canvas = part("stage");
const view = eye();
const seen = { before: null, after: null, since: 0, stale: true };
// For whoever measures: how much came and was drawn, and where an object is, in [m] and in the window [px].
const counted = {
  moments: 0,
  drawn: 0,
  where: (name) => [...placeOf(name)].slice(0, 2),
  inWindow(name) {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    const [x, y] = inPicture(look, placeOf(name));
    return [left + ((x + 1) / 2) * width, top + ((1 - y) / 2) * height];
  },
};
const placeOf = (name) => seen.after.poses.subarray(7 * stage.rows[OBJECTS.indexOf(name)]).subarray(0, 3);
let state = null;
let rates = [];
let stage = null;
let look = null;
const FINEST = FINENESS.findIndex((each) => each <= (window.devicePixelRatio || 1));
let fineness = FINEST;
const last = { fineness: -1, at: 0 };
let slow = [];
let quiet = 0;
window.wordarmLive = counted;

const setInsides = insides();
const ask = link({
  hello(greeting) {
    part("who").textContent = `${greeting.agent} on the ${greeting.robot}`;
    words(greeting.actions, (word) => ask({ do: "say", words: word }));
    rates = greeting.traces;
    if (state) show(state);
    furnish();
  },
  moment(bytes) {
    counted.moments += 1;
    const now = performance.now();
    const moment = readMoment(bytes);
    if (seen.after && alike(seen.after, moment)) return;
    seen.before = seen.after?.seconds < moment.seconds ? seen.after : null;
    seen.after = moment;
    seen.since = now;
    seen.stale = true;
  },
  state(news) {
    if (news.step < rates.length || news.step === 0) rates = rates.slice(0, news.step);
    if (news.rates && news.step > rates.length) rates.push(...Array(news.step - rates.length).fill(news.rates));
    state = news;
    show(news);
    setInsides(news);
    drawTraces(part("traces"), rates, news.changes);
    hint();
  },
  refused: say,
  cut(reason) {
    veil(reason || "The robot does not answer; trying again …");
    [seen.before, seen.after] = [null, null];
  },
});

/** Fetch the scene once, as fine as what draws here can bear. */
async function furnish() {
  if (!stage) {
    const drawer = context(canvas);
    if (!drawer) return veil("This page draws with WebGL 2, which this browser does not offer.");
    if (!drawer.fine) [fineness, slow] = [SOFTWARE_FROM, []];
    const answer = await fetch(drawer.fine ? "scene-fine" : "scene-coarse");
    stage = drawing(drawer.gl, readScene(await answer.arrayBuffer()), drawer.fine);
  }
  veil("");
}

/** A sentence over the picture for a while. */
function say(sentence) {
  part("hint").textContent = sentence[0].toUpperCase() + sentence.slice(1) + ".";
  quiet = performance.now() + 4000;
}

function hint() {
  if (performance.now() < quiet || !state) return;
  part("hint").textContent = state.phase === "running" ? "Drag to look round, scroll to come nearer."
    : "Drag an object to another place, or the table to look round.";
}

function veil(sentence) {
  part("veil").textContent = sentence;
  part("veil").hidden = !sentence;
}

/** One picture, if there is anything new to see. */
function picture(now) {
  requestAnimationFrame(picture);
  if (!stage || !seen.after) return;
  const still = !seen.stale && last.fineness !== FINEST && resting() && now - last.at > STILL_MS;
  if (!seen.stale && !still) return;
  Object.assign(last, { fineness: still ? FINEST : fineness, at: now });
  const width = Math.round(canvas.clientWidth * FINENESS[last.fineness]);
  const height = Math.round(canvas.clientHeight * FINENESS[last.fineness]);
  if (!width || !height) return;
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  look = looking(view, width, height);
  const part_ = Math.min(1, (performance.now() - seen.since) / PERIOD_MS);
  const moment = between(seen.before, seen.after, part_);
  draw(stage, moment, look, width, height);
  counted.drawn += 1;
  part("clock").textContent = `${moment.seconds.toFixed(1)} s`;
  seen.stale = part_ < 1 && seen.before !== null;
  adapt(now);
}

/** Whether time stands still: then there is time for a fine picture. */
function resting() {
  return state?.phase !== "running" || state.paused;
}

/** Draw less where pictures come too slowly while time goes on. */
function adapt(now) {
  if (resting()) return (slow = []);
  slow.push(now);
  if (slow.length <= TRIED) return;
  const each = (now - slow[0]) / TRIED;
  slow = [];
  if (each < SLOW_MS) return;
  if (stage.shaded && fineness >= SOFTWARE_FROM + 1) stage.shaded = false;
  else fineness = Math.min(fineness + 1, FINENESS.length - 1);
}

hand(canvas, {
  eye: view,
  look: () => look,
  moment: () => seen.after,
  rows: () => stage.rows,
  movable(asked) {
    const free = state !== null && state.phase !== "running";
    if (asked && !free) say("objects are moved between trials; wait for the verdict, or go back to the start");
    return free;
  },
  place: (object, x, y) => ask({ do: "place", object, x: x / stage.head.plane.scale, y: y / stage.head.plane.scale }),
  turned() {
    seen.stale = true;
  },
});

const reset = (changed) => ask({ do: "reset", ...changed });
part("run").addEventListener("click", () => {
  if (state.phase === "ended") ask({ do: "again" });
  ask({ do: "run", on: state.phase !== "running" || state.paused });
});
part("again").addEventListener("click", () => ask({ do: "again" }));
part("speed").addEventListener("change", ({ target }) => ask({ do: "speed", factor: Number(target.value) }));
part("area").addEventListener("change", ({ target }) => reset({ area: target.value }));
part("seed").addEventListener("change", ({ target }) => reset({ seed: Math.max(0, Math.floor(Number(target.value)) || 0) }));
part("shuffle").addEventListener("click", () => reset({ seed: state.seed + 1 }));
part("loop").addEventListener("change", ({ target }) => ask({ do: "loop", closed: target.value === "closed" }));
for (const button of document.querySelectorAll("[data-view]")) {
  button.addEventListener("click", () => {
    jump(view, button.dataset.view);
    seen.stale = true;
    for (const each of document.querySelectorAll("[data-view]")) each.setAttribute("aria-pressed", String(each === button));
  });
}
canvas.addEventListener("keydown", (event) => {
  if (event.key !== " ") return;
  event.preventDefault();
  part("run").click();
});
new ResizeObserver(() => {
  seen.stale = true;
  if (state) drawTraces(part("traces"), rates, state.changes);
}).observe(document.body);
requestAnimationFrame(picture);
