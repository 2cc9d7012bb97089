// What the camera on the arm sees: three sectors, and in each whether it holds blue, green or red.
// As `sense_camera` and arm2d/kernel/camera_at_end.py.

import { bearing, sinCos } from "./arithmetic.js";
import { MIDDLE_SECTOR_HALF_WIDTH, S1_LENGTH, VIEW_HALF_WIDTH } from "./world.js";

/** Nine inputs, sector by sector from the right, each 0 or 1 for blue, green and red. */
export function look(world, alpha, discs) {
  const seen = discs.map((disc) => sectorsOf(world.fromEnd ? fromEnd(world, alpha, disc) : fromBase(alpha, disc)));
  const white = [alpha <= world.whiteRight, false, alpha >= world.whiteLeft];
  return white.flatMap((all, sector) => seen.map((sectors) => (all || sectors[sector] ? 1 : 0)));
}

/** Whether the centre of a disc lies in the camera's field. */
export function inView(world, alpha, disc) {
  if (!world.fromEnd) return offsetOf(alpha, disc) <= VIEW_HALF_WIDTH;
  if (!meetsField(fromBase(alpha, disc))) return false;
  return Math.abs(seenFromEnd(alpha, disc).offset) <= VIEW_HALF_WIDTH;
}

/** The smaller angle between S1 and the bearing of a disc [deg]. */
export function offsetOf(alpha, disc) {
  const away = Math.abs(disc.bearing - alpha);
  return away <= 180.0 ? away : 360.0 - away;
}

/** From where to where a disc is seen from J1, relative to S1 [deg]. */
function fromBase(alpha, disc) {
  return [disc.low - alpha, disc.high - alpha];
}

/** The same from the end of S1; nothing, where J1 does not see it either. */
function fromEnd(world, alpha, disc) {
  if (!meetsField(fromBase(alpha, disc))) return null;
  const { offset, squared } = seenFromEnd(alpha, disc);
  if (!world.anyPart) return [offset, offset];
  const beyond = squared - world.radius * world.radius;
  if (beyond <= 0.0) return [-180.0, 180.0];
  const half = bearing(Math.sqrt(beyond), world.radius);
  return [offset - half, offset + half];
}

/** Whether an interval meets the camera's field. */
function meetsField([low, high]) {
  return low <= VIEW_HALF_WIDTH && high >= -VIEW_HALF_WIDTH;
}

/** A disc's bearing from the end of S1, relative to S1 [deg], and its squared distance from there [cm^2]. */
function seenFromEnd(alpha, disc) {
  const [sine, cosine] = sinCos(disc.bearing - alpha);
  const x = disc.distance * cosine - S1_LENGTH;
  const y = disc.distance * sine;
  const offset = bearing(x, y);
  return { offset: offset <= 180.0 ? offset : offset - 360.0, squared: x * x + y * y };
}

/** Which of the sectors right, middle and left an interval meets. */
function sectorsOf(interval) {
  if (interval === null) return [false, false, false];
  const [low, high] = interval;
  const inner = MIDDLE_SECTOR_HALF_WIDTH;
  return [
    low < -inner && high >= -VIEW_HALF_WIDTH,
    low <= inner && high >= -inner,
    low <= VIEW_HALF_WIDTH && high > inner,
  ];
}
