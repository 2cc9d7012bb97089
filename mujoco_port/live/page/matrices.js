// Matrices of four rows, column by column, and vectors of three.

export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
];

/** The vector at length 1. */
export function unit(a) {
  const length = Math.hypot(...a) || 1;
  return [a[0] / length, a[1] / length, a[2] / length];
}

/** From the world to a camera at `eye` that looks at `target`; `above` is up in its picture. */
export function lookAt(eye, target, above) {
  const back = unit(subtract(eye, target));
  const right = unit(cross(above, back));
  const up = cross(back, right);
  return [
    right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
    -dot(right, eye), -dot(up, eye), -dot(back, eye), 1,
  ];
}

/** A camera's picture, `tangent` being that of half its height. */
export function perspective(tangent, aspect, near, far) {
  const deep = 1 / (near - far);
  return [1 / (tangent * aspect), 0, 0, 0, 0, 1 / tangent, 0, 0, 0, 0, (near + far) * deep, -1, 0, 0, 2 * near * far * deep, 0];
}

/** A box of half the edges `x`, `y`, seen without perspective. */
export function box(x, y, near, far) {
  return [1 / x, 0, 0, 0, 0, 1 / y, 0, 0, 0, 0, 2 / (near - far), 0, 0, 0, (near + far) / (near - far), 1];
}

/** a times b. */
export function multiply(a, b) {
  const out = new Array(16).fill(0);
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 4; row++) {
      for (let k = 0; k < 4; k++) out[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return out;
}
