// Random starts. The generator is Park and Miller's "minimal standard": x becomes 48271 x mod 2**31 - 1, all
// of it exact in doubles; a draw is x / (2**31 - 1). Fine for the few thousand draws of this page.

const MODULUS = 2147483647;
const MULTIPLIER = 48271;

/** A function that draws numbers in (0, 1); the same seed from 1 to 2**31 - 2 gives the same draws. */
export function generator(seed) {
  let x = seed % MODULUS || 1;
  return () => {
    x = (MULTIPLIER * x) % MODULUS;
    return x / MODULUS;
  };
}

/** A start: S1 uniform in the right (0) or left (1) area, each object uniform on its chord. */
export function drawStart(world, area, draw) {
  const [low, high] = world.starts[area];
  const alpha = low + (high - low) * draw();
  const centres = world.chords.map(([from, to]) => {
    const part = draw();
    return [0, 1].map((axis) => from[axis] + (to[axis] - from[axis]) * part);
  });
  return { alpha, centres };
}
