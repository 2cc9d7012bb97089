// Exponential, sigmoid, sine, cosine and bearing from + - * / and square root alone, operation by operation
// those of arm2d/arithmetic.py. IEEE 754 fixes these five to the last bit, so this page decides every step
// as the compiled Python does; Math.exp and its kin differ from one browser to the next.

// Adding and subtracting 1.5 * 2**52 rounds a small number to the nearest whole one.
const ROUNDER = 6755399441055744.0;
const LOG2_E = 1.4426950408889634;
// ln 2 in two parts; whole multiples (up to 2**20) of the first are exact.
const LN2_HIGH = 0.6931471803691238;
const LN2_LOW = 1.9082149292705877e-10;
const RADIANS_PER_DEGREE = Math.PI / 180.0;
export const DEGREES_PER_RADIAN = 180.0 / Math.PI;
// atan(k / 8) [rad], k = 0..8.
const ATAN_EIGHTHS = [
  0.0, 0.12435499454676144, 0.24497866312686414, 0.3587706702705722, 0.4636476090008061, 0.5585993153435624,
  0.6435011087932844, 0.7188299996216245, 0.7853981633974483,
];

/** 1 / n for n = 0..272: the factors of the series below. */
const RECIPROCALS = Array.from({ length: 273 }, (_, n) => 1.0 / n);

const bits = new Float64Array(1);
const words = new Int32Array(bits.buffer);
bits[0] = 1.0;
/** Which half of a double holds its exponent on this machine. */
const HIGH = words[1] === 0 ? 0 : 1;

/** 2**k for a whole number k in [-1022, 1023], by its bits: `2 ** k` is not promised to be exact. */
function powerOfTwo(k) {
  words[HIGH] = (k + 1023) << 20;
  words[1 - HIGH] = 0;
  return bits[0];
}

/** c of exp(r) = (c + r) / (c - r): r coth(r / 2) as a series in z = r * r. */
function cothSeries(z) {
  return (
    2.0 +
    z * (1.0 / 6.0 + z * (-1.0 / 360.0 + z * (1.0 / 15120.0 + z * (-1.0 / 604800.0 + z * (1.0 / 23950080.0)))))
  );
}

/** e**x for |x| <= 700. */
export function exp(x) {
  const k = x * LOG2_E + ROUNDER - ROUNDER;
  const r = x - k * LN2_HIGH - k * LN2_LOW;
  const c = cothSeries(r * r);
  return (powerOfTwo(k) * (c + r)) / (c - r);
}

/** 1 / (1 + e**-x) for |x| <= 700, with a single division. */
export function sigmoid(x) {
  const k = -x * LOG2_E + ROUNDER - ROUNDER;
  const r = -x - k * LN2_HIGH - k * LN2_LOW;
  const c = cothSeries(r * r);
  return (c - r) / (c - r + powerOfTwo(k) * (c + r));
}

/** [sine, cosine] of an angle in degrees: Taylor series after taking off quarter turns. */
export function sinCos(angle) {
  if (-44.9 < angle && angle < 44.9) return sinCosOfSmall(angle * RADIANS_PER_DEGREE);
  const quarter = angle / 90.0 + ROUNDER - ROUNDER;
  const [sine, cosine] = sinCosOfSmall((angle - 90.0 * quarter) * RADIANS_PER_DEGREE);
  const turns = ((quarter % 4) + 4) % 4;
  if (turns === 0) return [sine, cosine];
  if (turns === 1) return [cosine, -sine];
  if (turns === 2) return [-sine, -cosine];
  return [-cosine, sine];
}

/** [sine, cosine] of r in [-pi/4, pi/4] rad. */
function sinCosOfSmall(r) {
  const z = r * r;
  let sine = 0.0;
  let cosine = 0.0;
  for (let n = 16; n > 0; n -= 2) {
    sine = (1.0 - sine) * z * RECIPROCALS[n * (n + 1)];
    cosine = (1.0 - cosine) * z * RECIPROCALS[n * (n - 1)];
  }
  return [r - r * sine, 1.0 - cosine];
}

/** Arc tangent of t in [0, 1], in radians: from the nearest eighth, then a Taylor series. */
function atanOfRatio(t) {
  const nearest = Math.floor(8.0 * t + 0.5);
  const c = nearest / 8.0;
  const s = (t - c) / (1.0 + t * c);
  const z = s * s;
  let series = 0.0;
  for (let n = 15; n > 1; n -= 2) series = z * (RECIPROCALS[n] - series);
  return ATAN_EIGHTHS[nearest] + (s - s * series);
}

/** Direction of the point (x, y) in degrees, in [-90, 270). */
export function bearing(x, y) {
  const across = Math.abs(x);
  const along = Math.abs(y);
  if (across === 0.0 && along === 0.0) return 0.0;
  let angle =
    along <= across
      ? atanOfRatio(along / across) * DEGREES_PER_RADIAN
      : 90.0 - atanOfRatio(across / along) * DEGREES_PER_RADIAN;
  if (x < 0.0) {
    angle = 180.0 - angle;
    return y >= 0.0 ? angle : 360.0 - angle;
  }
  return y >= 0.0 ? angle : -angle;
}
