// Every number of the arm and its world: constants of the paper, and what a record of readings makes of
// the rest. Lengths in cm, angles in degrees; as arm2d/constants.py, arm2d/readings.py and
// arm2d/kernel/world.py have them.

import { DEGREES_PER_RADIAN, sinCos } from "./arithmetic.js";

export const S1_LENGTH = 100.0;
export const S2_LENGTH = 50.0;
export const ALPHA_MIN = -30.0;
export const ALPHA_MAX = 210.0;
export const BETA_MIN = 0.0;
export const BETA_MAX = 90.0;
export const CHORD_END_DISTANCE = 150.0;
export const VIEW_HALF_WIDTH = 15.0;
export const MIDDLE_SECTOR_HALF_WIDTH = 5.0;
export const DT = 0.1;
export const MAX_STEPS = 250;
export const SUB_STEPS = 4;
export const GOOD_STEPS_FOR_SUCCESS = 100;
export const THRESHOLD_TOLERANCE = 1e-9;
export const COLLISION_FACTOR = 0.6;
const PENETRATION_TOLERANCE = 1e-9;
export const TOUCH_TOLERANCE = 1e-6;

// Turns of a joint are rounded to this lattice, so that every sum of turns from 90 degrees is exact.
const TURN_LATTICE = 2.0 ** 44;

/** Turn of a joint per step, half-width of "on target", angle of a full MOVE [deg]. */
function turnSet(name) {
  if (name === "radians") return [0.05, 0.08, 0.6].map((angle) => angle * DEGREES_PER_RADIAN);
  return [2.9, 4.6, 34.4];
}

/** The world of a record of readings, named as in arm2d.Readings.to_mapping(). */
export function worldOf(readings) {
  const [printedTurn, targetCone, moveAngle] = turnSet(readings.turn);
  const turn = Math.round(printedTurn * TURN_LATTICE) / TURN_LATTICE;
  const near = readings.bound_vision === "near" ? VIEW_HALF_WIDTH : 0.0;
  const radius = readings.object_radius;
  const [quarterSine, quarterCosine] = sinCos(turn / SUB_STEPS);
  const hitGap = radius - PENETRATION_TOLERANCE;
  const touchGap = radius + TOUCH_TOLERANCE;
  return {
    turn,
    radius,
    targetCone,
    indicateCone: readings.indicate_angle === "wide" ? 30.0 : targetCone,
    moveAngle,
    whiteRight: ALPHA_MIN + near,
    whiteLeft: ALPHA_MAX - near,
    anyPart: readings.object_vision === "any_part",
    fromEnd: readings.camera_origin === "end",
    ignoreStops: readings.ignore_stops === "early",
    keep: readings.run_counting === "cumulative" ? 1.0 : 0.0,
    wholePenalty: readings.collision_penalty === "whole",
    bestStretch: readings.f3_time === "best",
    strictSuccess: readings.success === "f1_f2_f3",
    quarterSine,
    quarterCosine,
    hitGapSquared: hitGap * hitGap,
    touchGapSquared: touchGap * touchGap,
    sideReach: ((1.1 * radius) / (S1_LENGTH - radius)) * DEGREES_PER_RADIAN + 1.4 * turn,
    starts: startIntervals(readings),
    chords: chords(readings),
  };
}

/** Where S1 may start [deg]: the right and the left area. */
function startIntervals(readings) {
  if (readings.start_areas === "bounds") return [[-30.0, 0.0], [180.0, 210.0]];
  const [blue, green, red] = readings.sector_centres;
  const half = readings.start_half_width;
  return [(blue + green) / 2, (green + red) / 2].map((middle) => [middle - half, middle + half]);
}

/** Both ends [x, y] of the chord that each object may start on. */
function chords(readings) {
  return readings.sector_centres.map((centre) =>
    [-1.0, 1.0].map((side) => {
      const [sine, cosine] = sinCos(centre + side * readings.sector_half_width);
      return [CHORD_END_DISTANCE * cosine, CHORD_END_DISTANCE * sine];
    }),
  );
}
