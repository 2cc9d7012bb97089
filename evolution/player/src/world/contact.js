// Objects against the forearm, as arm2d/kernel/contact.py: an object that S2 runs into is pushed out of its
// way, and carried while they touch. A disc is { bearing, distance, low, high, side }: its direction and
// distance from J1 [deg, cm], the edges that can be seen of it [deg], and where it touches S2.

import { bearing, sinCos } from "./arithmetic.js";
import { BETA_MAX, S1_LENGTH, S2_LENGTH, SUB_STEPS, TOUCH_TOLERANCE } from "./world.js";

export const NONE = 0;
export const RIGHT = 1;
export const LEFT = 2;
// In radians, and 0.3 % more.
const LITTLE_MORE_THAN_A_DEGREE = 0.0175;
const largestBetas = new Map();

/** A disc at a bearing [deg] and a distance [cm] from J1. */
export function placeDisc(world, bearingOfCentre, distance, side = NONE) {
  const half = world.anyPart
    ? bearing(Math.sqrt(distance * distance - world.radius * world.radius), world.radius)
    : 0.0;
  return { bearing: bearingOfCentre, distance, low: bearingOfCentre - half, high: bearingOfCentre + half, side };
}

/** A disc whose centre stands at [x, y] cm. */
export function placeAt(world, [x, y]) {
  return placeDisc(world, bearing(x, y), Math.sqrt(x * x + y * y));
}

/**
 * The discs after the arm has moved.
 *
 * @param before { beta, discs } before the step, and `fresh` where a disc has just been put down.
 * @param after { alpha, beta, turned, bent } after it.
 */
export function touchDiscs(world, before, after) {
  const moved = after.turned !== 0.0 || after.bent !== 0.0 || before.fresh;
  if (!moved || before.beta >= betaLimit(world, before.discs)) return before.discs;
  // Seen along S1, S2's tip lies beta / 3 to the left at the most.
  const leftOf = (after.beta - after.bent) / 3.0 + world.sideReach;
  return before.discs.map((disc) => {
    const offset = disc.bearing - after.alpha;
    return -world.sideReach < offset && offset < leftOf ? resolve(world, disc, after) : { ...disc, side: NONE };
  });
}

/** Move one disc with or out of S2's way. It is followed in S1's frame, where S2 turns about (100, 0). */
function resolve(world, disc, arm) {
  let [sine, cosine] = sinCos(disc.bearing - (arm.alpha - arm.turned));
  let x = disc.distance * cosine;
  let y = disc.distance * sine;
  let [sinBeta, cosBeta] = sinCos(arm.beta - arm.bent);
  let side = disc.side;
  let moved = false;
  let u0 = along(x, y, sinBeta, cosBeta);
  let v0 = leftward(x, y, sinBeta, cosBeta);
  let beyond = beyondEnds(u0);
  // No gap shrinks by more than the arcs that the disc and S2's points run through in S1's frame.
  const motion = disc.distance * Math.abs(arm.turned) + S2_LENGTH * Math.abs(arm.bent);
  const reach = world.radius + 2.0 * TOUCH_TOLERANCE + LITTLE_MORE_THAN_A_DEGREE * motion;
  if (side === NONE && beyond * beyond + v0 * v0 > reach * reach) return disc;
  [sine, cosine] = subStep(world, -arm.turned); // in S1's frame a resting disc turns the other way
  const [sinBend, cosBend] = subStep(world, arm.bent);
  for (let part = 0; part < SUB_STEPS; part++) {
    [sinBeta, cosBeta] = [sinBeta * cosBend + cosBeta * sinBend, cosBeta * cosBend - sinBeta * sinBend];
    [x, y] = [x * cosine - y * sine, x * sine + y * cosine];
    let u = along(x, y, sinBeta, cosBeta);
    let v = leftward(x, y, sinBeta, cosBeta);
    beyond = beyondEnds(u);
    const gapSquared = beyond * beyond + v * v;
    if (gapSquared < world.hitGapSquared) {
      if (side !== NONE) {
        [u, v] = [u0, v0]; // carried along
      } else {
        side = v0 < 0.0 ? RIGHT : LEFT;
        v = Math.sqrt(world.radius * world.radius - beyond * beyond); // pushed aside
        v = side === RIGHT ? -v : v;
      }
      x = S1_LENGTH + u * cosBeta - v * sinBeta;
      y = u * sinBeta + v * cosBeta;
      moved = true;
    } else {
      side = gapSquared > world.touchGapSquared ? NONE : v < 0.0 ? RIGHT : LEFT;
    }
    [u0, v0] = [u, v];
  }
  if (!moved) return { ...disc, side };
  return placeDisc(world, arm.alpha + bearing(x, y), Math.sqrt(x * x + y * y), side);
}

/** From which beta on S2 can meet no disc within a step [deg]. */
function betaLimit(world, discs) {
  const nearest = Math.min(discs[0].distance, discs[1].distance, discs[2].distance);
  return largestBetaThatReaches(Math.trunc(nearest - world.radius)) + world.turn;
}

/** The beta at which S2's tip is so far from J1 [cm]; 90 if it always is, -90 if never. */
function largestBetaThatReaches(distance) {
  if (!largestBetas.has(distance)) {
    const rest = distance * distance - S1_LENGTH * S1_LENGTH - S2_LENGTH * S2_LENGTH;
    const cosine = rest / (2.0 * S1_LENGTH * S2_LENGTH);
    const beta = cosine <= 0.0 ? BETA_MAX : bearing(cosine, Math.sqrt(1.0 - cosine * cosine)) + 1e-3;
    largestBetas.set(distance, cosine > 1.0 ? -BETA_MAX : beta);
  }
  return largestBetas.get(distance);
}

/** [sine, cosine] of one sub-step of a joint's turn; a turn is full unless a bound cut it. */
function subStep(world, turn) {
  if (turn === 0.0) return [0.0, 1.0];
  if (turn === world.turn) return [world.quarterSine, world.quarterCosine];
  if (turn === -world.turn) return [-world.quarterSine, world.quarterCosine];
  return sinCos(turn / SUB_STEPS);
}

/** How far along S2 from J2 the point (x, y) in S1's frame lies. */
function along(x, y, sinBeta, cosBeta) {
  return (x - S1_LENGTH) * cosBeta + y * sinBeta;
}

/** How far to the left of S2 it lies. */
function leftward(x, y, sinBeta, cosBeta) {
  return y * cosBeta - (x - S1_LENGTH) * sinBeta;
}

/** How far u lies beyond either end of S2 [cm]. */
function beyondEnds(u) {
  if (u < 0.0) return -u;
  return u > S2_LENGTH ? u - S2_LENGTH : 0.0;
}
