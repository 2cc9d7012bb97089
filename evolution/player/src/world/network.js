// The agent's 25 neurons: 84 genes become weights, and the weights think, as arm2d/network/controller.py and
// arm2d/kernel/controller.py have it. Sums run in the same order: a recurrent network would blow up a
// difference in the last bit.

import { exp, sigmoid } from "./arithmetic.js";
import { ALPHA_MAX, ALPHA_MIN, BETA_MAX, BETA_MIN, DT } from "./world.js";

const LN_10 = 2.302585092994046;
const TAU_EXPONENT_MIN = -1.0;
const INPUT_BIAS_RANGES = { symmetric: [-4.0, 4.0], negative: [-4.0, -2.0] };
// Inputs summed group by group: [first, how many].
const TOUCH = [0, 2];
const SECTORS = [[2, 3], [5, 3], [8, 3]];
const BEND = 11;
const WORDS = [12, 6];
/** Nothing silenced. */
export const INTACT = { action: false, object: false, neurons: [false, false, false] };

/** The network that a genotype of 84 genes in [0, 1] stands for, under these readings. */
export function decode(genotype, readings) {
  const between = ([low, high], first, count) =>
    genotype.slice(first, first + count).map((gene) => low + (high - low) * gene);
  const exponents = between([TAU_EXPONENT_MIN, readings.tau_exponent_max], 75, 3);
  const inputBias = between(INPUT_BIAS_RANGES[readings.bias_ranges], 78, 1)[0];
  const gain = between([1.0, 13.0], 83, 1)[0];
  return {
    sensory: between([-8.0, 8.0], 0, 54), // 3 i + j: from input i to neuron j
    recurrent: between([-10.0, 10.0], 54, 9), // 3 k + j: from neuron k to neuron j
    motor: between([-10.0, 10.0], 63, 12), // 4 j + m: from neuron j to motor m
    rates: exponents.map((exponent) => DT / exp(LN_10 * exponent)),
    biases: between([-5.0, 5.0], 79, 3),
    motorBias: between([-5.0, 5.0], 82, 1)[0],
    inputBias,
    gain,
    off: sigmoid(inputBias), // a sensory neuron whose input is 0
    on: sigmoid(gain + inputBias), // and 1
  };
}

/** What the neurons say to one another in states y: three numbers in (0, 1), or 0 where silenced. */
export function outputs(network, y, silenced) {
  return y.map((state, k) => (silenced.neurons[k] ? 0.0 : sigmoid(state + network.biases[k])));
}

/** The three states one tenth of a second later. */
export function think(network, y, z, inputs) {
  return y.map((state, j) => {
    const w = network.recurrent;
    const recurrent = w[j] * z[0] + w[3 + j] * z[1] + w[6 + j] * z[2];
    return state + network.rates[j] * (drive(network, inputs, j) + recurrent - state);
  });
}

/** What the 18 inputs drive in neuron j. */
function drive(network, inputs, j) {
  const sum = ([first, count]) => {
    let total = 0.0;
    for (let i = first; i < first + count; i++) {
      total += network.sensory[3 * i + j] * (inputs[i] ? network.on : network.off);
    }
    return total;
  };
  const camera = sum(SECTORS[0]) + sum(SECTORS[1]) + sum(SECTORS[2]);
  const bend = network.sensory[3 * BEND + j] * sigmoid(network.gain * inputs[BEND] + network.inputBias);
  return sum(WORDS) + sum(TOUCH) + camera + bend;
}

/** What goes into the four motors: whether and which way S1 turns, whether and which way S2 does. */
export function motorInputs(network, z) {
  const w = network.motor;
  return [0, 1, 2, 3].map((m) => w[m] * z[0] + w[4 + m] * z[1] + w[8 + m] * z[2] + network.motorBias);
}

/** Both joints' angles after a step of the motors. */
export function turnJoints(motors, alpha, beta, turn) {
  return [
    turned(alpha, motors[0], motors[1], turn, ALPHA_MIN, ALPHA_MAX),
    turned(beta, motors[2], motors[3], turn, BETA_MIN, BETA_MAX),
  ];
}

/** An angle after a turn, cut off at the joint's bounds. A motor counts as on where its input is positive. */
function turned(angle, go, way, turn, low, high) {
  const by = go > 0.0 ? (way < 0.0 ? turn : way > 0.0 ? -turn : 0.0) : 0.0;
  return Math.min(high, Math.max(low, angle + by));
}
