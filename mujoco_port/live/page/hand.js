// The reader's hand: objects are dragged over the table, the eye round it.

import { OBJECTS } from "./scene.js";
import { onHeight, orbit, zoom } from "./view.js";

const MIDDLE = 0.0225; // [m], height of an object's middle
const NEAR = 0.035; // [m], how near the pointer has to be
const NEAR_FINGER = 0.06;
const EVERY_MS = 40;

/** Let the pointer act on a canvas. `world` gives { eye, look(), moment(), movable(), place(name, x, y), turned() }. */
export function hand(canvas, world) {
  const pointers = new Map();
  let held = null;
  let sent = 0;

  const point = (event) => {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    return [(2 * (event.clientX - left)) / width - 1, 1 - (2 * (event.clientY - top)) / height];
  };
  const onTable = (event) => onHeight(world.look(), ...point(event), MIDDLE);
  const under = (event) => {
    const place = onTable(event);
    const moment = world.moment();
    if (!place || !moment) return null;
    const far = world.rows().map((row) => Math.hypot(moment.poses[7 * row] - place[0], moment.poses[7 * row + 1] - place[1]));
    const nearest = far.indexOf(Math.min(...far));
    return far[nearest] < (event.pointerType === "touch" ? NEAR_FINGER : NEAR) ? OBJECTS[nearest] : null;
  };
  const put = (event, now) => {
    const place = onTable(event);
    if (!place || (!now && event.timeStamp - sent < EVERY_MS)) return;
    sent = event.timeStamp;
    world.place(held, place[0], place[1]);
  };

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    const name = pointers.size === 1 ? under(event) : null;
    held = name && world.movable(true) ? name : null;
    canvas.classList.toggle("held", true);
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) {
      canvas.classList.toggle("over", world.movable(false) && under(event) !== null);
      return;
    }
    if (held) return put(event, false);
    const now = [event.clientX, event.clientY];
    if (pointers.size === 2) {
      const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
      const apart = (one) => Math.hypot(one[0] - other[0], one[1] - other[1]) || 1;
      zoom(world.eye, apart(before) / apart(now));
    } else {
      orbit(world.eye, 0.006 * (now[0] - before[0]), 0.006 * (now[1] - before[1]));
    }
    pointers.set(event.pointerId, now);
    world.turned();
  });
  const leave = (event) => {
    if (held && event.type === "pointerup") put(event, true);
    pointers.delete(event.pointerId);
    held = null;
    canvas.classList.remove("held");
  };
  canvas.addEventListener("pointerup", leave);
  canvas.addEventListener("pointercancel", leave);
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(world.eye, Math.exp(0.001 * event.deltaY));
    world.turned();
  }, { passive: false });
}
