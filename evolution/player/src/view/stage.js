// The table from above: arm, camera light, objects. Drawn once, then moved.

import { RIGHT, LEFT, NONE } from "../world/contact.js";
import { arc, fixed, joints, limb, polar, slice } from "./geometry.js";
import { set, svg, write } from "./svg.js";
import { ACTIONS, OBJECTS } from "../world/words.js";
import { ALPHA_MAX, ALPHA_MIN, MIDDLE_SECTOR_HALF_WIDTH, S1_LENGTH, VIEW_HALF_WIDTH } from "../world/world.js";

// What the picture shows [cm]; x, y downwards, width, height.
const VIEW = [-178, -184, 356, 282];
const LIGHT_REACH = 168;
// An object may be put down between these distances from J1 [cm] and bearings [deg].
export const NEAREST = 106;
const FARTHEST = 162;
const BEARINGS = [-36, 216];
// A finger needs more than an object's 5 cm [cm].
const HANDLE = 13;
const S1_WIDTHS = [12, 8];
const S2_WIDTHS = [4.6, 3];

/**
 * Draw the table of a world into `root`.
 *
 * @param onMove Called with (object, [x, y]) in cm when the reader moves an object.
 */
export function makeStage(root, world, onMove) {
  root.replaceChildren();
  set(root, { viewBox: VIEW.join(" "), "aria-hidden": "false" });
  const light = lightOf(root);
  drawGround(root, world);
  const heard = makeHeard(root);
  const sectors = [0, 1, 2].map(() => svg(root, "path", { class: "wa-sector", fill: `url(#${light.id})` }));
  const trail = svg(root, "path", { class: "wa-trail" });
  const s2 = svg(root, "path", { class: "wa-s2" });
  const edges = [RIGHT, LEFT].map(() => svg(root, "path", { class: "wa-edge" }));
  const s1 = svg(root, "path", { class: "wa-s1" });
  const discs = OBJECTS.map((name, k) => makeDisc(root, name, world.radius, (centre) => onMove(k, centre)));
  svg(root, "circle", { class: "wa-base", r: 11 });
  svg(root, "circle", { class: "wa-joint", r: 4.6 });
  const elbow = svg(root, "circle", { class: "wa-joint", r: 3.6 });
  return {
    /** Show { alpha, beta, discs, sides, sees, heard, silenced, lit, target, progress, kind, trail }. */
    show(scene) {
      heard(scene);
      const arm = joints(scene.alpha, scene.beta);
      showLight(world, light, sectors, scene, arm);
      set(s1, { d: limb([0, 0], arm.elbow, ...S1_WIDTHS) });
      set(s2, { d: limb(arm.elbow, arm.tip, ...S2_WIDTHS) });
      edges.forEach((edge, k) => showEdge(edge, arm, scene, [RIGHT, LEFT][k]));
      set(elbow, { cx: arm.elbow[0].toFixed(2), cy: arm.elbow[1].toFixed(2) });
      set(trail, { d: scene.trail.length > 1 ? `M${scene.trail.map(fixed).join("L")}` : "" });
      discs.forEach((disc, k) => disc.show(scene, k, world.radius));
    },
  };
}

/** The camera's light: bright at the arm, gone where the table ends. */
function lightOf(root) {
  const id = `wa-light-${(lightOf.count = (lightOf.count ?? 0) + 1)}`;
  const gradient = svg(svg(root, "defs"), "radialGradient", { id, gradientUnits: "userSpaceOnUse", r: LIGHT_REACH });
  for (const [offset, opacity] of [[0, 1], [0.6, 0.75], [1, 0]]) {
    svg(gradient, "stop", { class: "wa-glow", offset, "stop-opacity": opacity });
  }
  return { id, gradient };
}

function showLight(world, light, sectors, scene, arm) {
  const eye = world.fromEnd ? arm.elbow : [0, 0];
  set(light.gradient, { cx: eye[0].toFixed(2), cy: eye[1].toFixed(2) });
  const bounds = [-VIEW_HALF_WIDTH, -MIDDLE_SECTOR_HALF_WIDTH, MIDDLE_SECTOR_HALF_WIDTH, VIEW_HALF_WIDTH];
  sectors.forEach((sector, k) => {
    set(sector, { d: slice(scene.alpha + bounds[k], scene.alpha + bounds[k + 1], LIGHT_REACH, eye) });
    sector.classList.toggle("wa-on", scene.sees[k]);
  });
}

/** The two words, lit while the agent hears them; `show(scene)`. */
function makeHeard(root) {
  const text = svg(root, "text", { class: "wa-heard", y: 68, "aria-hidden": "true" });
  const [action, object] = [svg(text, "tspan"), svg(text, "tspan", { dx: "0.28em" })];
  return (scene) => {
    write(action, ACTIONS[scene.heard.action]);
    write(object, OBJECTS[scene.heard.object]);
    const state = (silent) => (silent ? "wa-silent" : scene.lit ? "wa-on" : "");
    set(action, { class: state(scene.silenced.action) });
    set(object, { class: `wa-${OBJECTS[scene.heard.object].toLowerCase()} ${state(scene.silenced.object)}` });
  };
}

/** One side of the forearm lights where something touches it. */
function showEdge(edge, { elbow, tip }, { alpha, beta, sides }, side) {
  const out = alpha + beta + (side === RIGHT ? -90 : 90);
  set(edge, { d: `M${fixed(polar(out, 2.4, elbow))}L${fixed(polar(out, 1.8, tip))}` });
  edge.classList.toggle("wa-on", sides.includes(side));
}

/** Faintly: how far the arm turns and reaches, where it starts, where the objects start. */
function drawGround(root, world) {
  const ground = svg(root, "g", { class: "wa-ground", "aria-hidden": "true" });
  svg(ground, "path", { d: arc(ALPHA_MIN, ALPHA_MAX, 150), class: "wa-reach" });
  svg(ground, "path", { d: arc(ALPHA_MIN, ALPHA_MAX, S1_LENGTH), class: "wa-dial" });
  for (let bearing = ALPHA_MIN; bearing <= ALPHA_MAX; bearing += 30) {
    svg(ground, "path", { d: `M${fixed(polar(bearing, 97))}L${fixed(polar(bearing, 103))}`, class: "wa-dial" });
  }
  for (const [low, high] of world.starts) svg(ground, "path", { d: arc(low, high, S1_LENGTH), class: "wa-start-area" });
  world.chords.forEach(([[x0, y0], [x1, y1]], k) =>
    svg(ground, "path", { d: `M${fixed([x0, -y0])}L${fixed([x1, -y1])}`, class: `wa-chord wa-${OBJECTS[k].toLowerCase()}` }),
  );
}

/** An object that can be dragged, or moved with the arrow keys. */
function makeDisc(root, name, radius, onMove) {
  const group = svg(root, "g", { class: `wa-disc wa-${name.toLowerCase()}`, tabindex: 0, role: "slider" });
  set(group, { "aria-label": `${name} object`, "aria-valuemin": BEARINGS[0], "aria-valuemax": BEARINGS[1] });
  svg(group, "circle", { class: "wa-handle", r: HANDLE });
  svg(group, "circle", { class: "wa-halo", r: radius + 6.5 });
  svg(group, "circle", { class: "wa-ring-track", r: radius + 3.6 });
  const ring = svg(group, "circle", { class: "wa-ring", r: radius + 3.6, pathLength: 1, transform: "rotate(-90)" });
  svg(group, "circle", { class: "wa-body", r: radius });
  const letter = svg(group, "text", { class: "wa-letter", dy: "0.36em", "aria-hidden": "true" });
  write(letter, name[0]);
  const label = svg(group, "text", { class: "wa-name", dy: "0.35em", "aria-hidden": "true" });
  write(label, name);
  let at = [0, 0];
  drag(root, group, onMove);
  group.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: [2, 0], ArrowRight: [-2, 0], ArrowUp: [0, 2], ArrowDown: [0, -2] }[event.key];
    if (!by) return;
    event.preventDefault();
    event.stopPropagation();
    const [bearing, distance] = toPolar(at);
    onMove(within(bearing + by[0], distance + by[1]));
  });
  return {
    show({ discs, sides, target, progress, kind }, k) {
      at = discs[k];
      const [bearing, distance] = toPolar(at);
      const isTarget = k === target;
      set(group, {
        transform: `translate(${fixed(at)})`,
        "aria-valuenow": bearing.toFixed(0),
        "aria-valuetext": `${bearing.toFixed(0)} degrees, ${distance.toFixed(0)} centimetres away`,
      });
      group.classList.toggle("wa-target", isTarget);
      group.classList.toggle("wa-touched", sides[k] !== NONE);
      group.classList.toggle("wa-done", isTarget && kind === "yes");
      set(ring, { "stroke-dasharray": `${isTarget ? progress.toFixed(3) : 0} 1` });
      const [x, y] = labelPlace(at, bearing, radius, VIEW[2] / (root.clientWidth || VIEW[2]));
      set(label, { x: x.toFixed(2), y: y.toFixed(2) });
    },
  };
}

/** Where an object's name stands, from its centre: outside, or below where the picture ends; `pixel` in cm. */
function labelPlace([x], bearing, radius, pixel) {
  const [outX, outY] = polar(bearing, 1);
  const edge = VIEW[2] / 2 - 22 * pixel;
  const across = outX * (radius + 9 + 18 * pixel);
  if (Math.abs(x + across) > edge) return [Math.min(edge, Math.max(-edge, x)) - x, radius + 9 + 7 * pixel];
  return [across, outY * (radius + 8 + 7 * pixel)];
}

/** Let a pointer drag `group` about. */
function drag(root, group, onMove) {
  group.addEventListener("pointerdown", (event) => {
    group.setPointerCapture(event.pointerId);
    group.classList.add("wa-dragged");
    event.preventDefault();
  });
  group.addEventListener("pointermove", (event) => {
    if (!group.hasPointerCapture(event.pointerId)) return;
    const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(root.getScreenCTM().inverse());
    onMove(within(...toPolar([point.x, point.y])));
  });
  for (const end of ["pointerup", "pointercancel"]) {
    group.addEventListener(end, () => group.classList.remove("wa-dragged"));
  }
}

/** [bearing in [-90, 270), distance] of a point of the picture. */
function toPolar([x, y]) {
  const bearing = (Math.atan2(-y, x) * 180) / Math.PI;
  return [bearing < -90 ? bearing + 360 : bearing, Math.hypot(x, y)];
}

/** The point [x, y] in the world nearest to a bearing and a distance where an object may stand. */
function within(bearing, distance) {
  const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
  const [x, y] = polar(clamp(bearing, ...BEARINGS), clamp(distance, NEAREST, FARTHEST));
  return [x, -y];
}

/** Tell the picture how many cm a pixel is, so that its letters keep their size. */
export function keepLetters(root) {
  const measure = () => root.style.setProperty("--px", VIEW[2] / (root.clientWidth || VIEW[2]));
  new ResizeObserver(measure).observe(root);
  measure();
}
