// Where things stand in the picture. Here any sine will do: nothing below decides an outcome.
// World: cm, y ahead of the agent. Picture: the same, y downwards.

import { S1_LENGTH, S2_LENGTH } from "../world/world.js";

const DEGREE = Math.PI / 180;

/** The point [x, y] of the picture at a bearing [deg] and a distance [cm] from `from`. */
export function polar(bearing, distance, [x, y] = [0, 0]) {
  return [x + distance * Math.cos(bearing * DEGREE), y - distance * Math.sin(bearing * DEGREE)];
}

/** The ends of S1 and S2 in the picture. */
export function joints(alpha, beta) {
  const elbow = polar(alpha, S1_LENGTH);
  return { elbow, tip: polar(alpha + beta, S2_LENGTH, elbow) };
}

/** A pie slice between two bearings [deg] around a point. */
export function slice(from, to, radius, centre = [0, 0]) {
  const [start, end] = [polar(from, radius, centre), polar(to, radius, centre)];
  const far = to - from > 180 ? 1 : 0;
  return `M${fixed(centre)}L${fixed(start)}A${radius} ${radius} 0 ${far} 0 ${fixed(end)}Z`;
}

/** An arc between two bearings [deg] around a point. */
export function arc(from, to, radius, centre = [0, 0]) {
  const far = to - from > 180 ? 1 : 0;
  return `M${fixed(polar(from, radius, centre))}A${radius} ${radius} 0 ${far} 0 ${fixed(polar(to, radius, centre))}`;
}

/** A limb that tapers from one width to another, with round ends. */
export function limb([x0, y0], [x1, y1], width0, width1) {
  const length = Math.hypot(x1 - x0, y1 - y0) || 1;
  const [nx, ny] = [-(y1 - y0) / length / 2, (x1 - x0) / length / 2];
  const corner = (x, y, width, side) => fixed([x + side * nx * width, y + side * ny * width]);
  const round = (width) => `A${width / 2} ${width / 2} 0 0 0 `;
  return (
    `M${corner(x0, y0, width0, -1)}${round(width0)}${corner(x0, y0, width0, 1)}` +
    `L${corner(x1, y1, width1, 1)}${round(width1)}${corner(x1, y1, width1, -1)}Z`
  );
}

/** A point as SVG writes it. */
export function fixed([x, y]) {
  return `${x.toFixed(2)} ${y.toFixed(2)}`;
}

/** `part` of the way from state a to state b of a trial: { alpha, beta, discs: [[x, y], ...] }. */
export function between(a, b, part) {
  const mix = (one, other) => one + (other - one) * part;
  const discs = a.discs.map((disc, k) => {
    const [from, to] = [disc, b.discs[k]].map(({ bearing, distance }) => polar(bearing, distance));
    return [mix(from[0], to[0]), mix(from[1], to[1])];
  });
  return { alpha: mix(a.alpha, b.alpha), beta: mix(a.beta, b.beta), discs };
}
