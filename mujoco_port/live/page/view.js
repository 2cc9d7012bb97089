// The reader's eye: it goes round the table, nearer and further away.

import { cross, lookAt, multiply, perspective, subtract, unit } from "./matrices.js";

const HALF_HEIGHT = Math.tan((21.5 * Math.PI) / 180);
const NARROWEST = 1.02; // as wide as the table needs, in heights of the picture
const VIEWS = {
  front: { turn: 0, rise: 0.5, away: 1.12, target: [-0.06, 0.09, 0.18] },
  above: { turn: 0, rise: 1.5, away: 1.02, target: [-0.02, 0.08, 0.0] },
};

/** An eye in front of the robot: what is on the robot's left is on the right of the picture. */
export function eye() {
  return { ...VIEWS.front };
}

/** Let the eye jump to a named place. */
export function jump(self, name) {
  Object.assign(self, VIEWS[name]);
}

/** Turn the eye by angles [rad]. */
export function orbit(self, turn, rise) {
  self.turn = Math.min(1.5, Math.max(-1.5, self.turn + turn));
  self.rise = Math.min(1.54, Math.max(0.06, self.rise + rise));
}

/** Bring the eye nearer by a factor. */
export function zoom(self, factor) {
  self.away = Math.min(2.2, Math.max(0.35, self.away * factor));
}

/** Where the eye is, and its matrix, for a picture of some width and height. */
export function looking(self, width, height) {
  const { turn, rise, away, target } = self;
  const flat = Math.cos(rise);
  const aspect = width / height;
  const far = aspect < NARROWEST ? (away * NARROWEST) / aspect : away;
  const way = [Math.sin(turn) * flat, Math.cos(turn) * flat, Math.sin(rise)];
  const place = target.map((each, k) => each + far * way[k]);
  const above = [-Math.sin(turn) * Math.sin(rise), -Math.cos(turn) * Math.sin(rise), flat];
  const matrix = multiply(perspective(HALF_HEIGHT, aspect, 0.05, 20), lookAt(place, target, above));
  return { place, target, above, aspect, matrix };
}

/** Where a place [m] is in the picture (from -1 to 1). */
export function inPicture({ matrix }, [x, y, z]) {
  const row = (k) => matrix[k] * x + matrix[4 + k] * y + matrix[8 + k] * z + matrix[12 + k];
  return [row(0) / row(3), row(1) / row(3)];
}

/** Where the ray through a point of the picture (from -1 to 1) meets the height `z` [m]; null if it does not. */
export function onHeight({ place, target, above, aspect }, x, y, z) {
  const ahead = unit(subtract(target, place));
  const right = unit(cross(ahead, above));
  const up = cross(right, ahead);
  const way = ahead.map((each, k) => each + HALF_HEIGHT * (x * aspect * right[k] + y * up[k]));
  const far = (z - place[2]) / way[2];
  return far > 0 ? [place[0] + far * way[0], place[1] + far * way[1]] : null;
}
