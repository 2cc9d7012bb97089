// How the inter-neurons' rates went, on a small canvas, with the words that were heard meanwhile.

const STEP_S = 0.1;
const LEAST_S = 25;
// Of the first three neurons' curves, of the next three, and so on.
const DASHES = [[], [6, 3], [2, 3], [9, 3, 2, 3], [1, 5], [12, 5]];
const EDGE = { left: 8, right: 8, top: 19, bottom: 17 };

/** Draw rates [K][N] and changes [[step, words], ...] in the page's own colours. */
export function drawTraces(canvas, rates, changes) {
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  const fine = window.devicePixelRatio || 1;
  if (canvas.width !== Math.round(width * fine)) canvas.width = Math.round(width * fine);
  if (canvas.height !== Math.round(height * fine)) canvas.height = Math.round(height * fine);
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(name).trim();
  const pen = canvas.getContext("2d");
  pen.setTransform(fine, 0, 0, fine, 0, 0);
  pen.clearRect(0, 0, width, height);
  pen.font = `11px ${colour("--sans")}`;
  const whole = Math.max(LEAST_S, rates.length * STEP_S);
  const across = (step) => EDGE.left + ((width - EDGE.left - EDGE.right) * step * STEP_S) / whole;
  const up = (rate) => height - EDGE.bottom - (height - EDGE.top - EDGE.bottom) * rate;
  grid(pen, colour, whole, across, up, height, width);
  marks(pen, colour, changes, across, up, width);
  const hues = [colour("--ink"), colour("--accent"), colour("--glow")];
  const count = rates.length ? rates[0].length : 0;
  for (let neuron = 0; neuron < count; neuron += 1) {
    pen.setLineDash(DASHES[Math.floor(neuron / hues.length) % DASHES.length]);
    curve(pen, hues[neuron % hues.length], rates, neuron, across, up);
  }
  pen.setLineDash([]);
}

/** Lines at rates 0 and 1, and seconds below. */
function grid(pen, colour, whole, across, up, height, width) {
  pen.strokeStyle = colour("--line");
  pen.lineWidth = 1;
  pen.beginPath();
  for (const rate of [0, 1]) {
    pen.moveTo(EDGE.left, up(rate));
    pen.lineTo(width - EDGE.right, up(rate));
  }
  pen.stroke();
  pen.fillStyle = colour("--soft");
  pen.textAlign = "center";
  const every = whole > 150 ? 50 : whole > 60 ? 20 : 5;
  for (let second = every; second < whole; second += every) {
    pen.fillText(`${second} s`, across(second / STEP_S), height - 4);
  }
}

/** Where other words were said. */
function marks(pen, colour, changes, across, up, width) {
  pen.strokeStyle = colour("--soft");
  pen.fillStyle = colour("--soft");
  pen.textAlign = "left";
  pen.setLineDash([3, 3]);
  changes.forEach(([step, words], number) => {
    const x = across(step);
    const room = (number + 1 < changes.length ? across(changes[number + 1][0]) : width) - x;
    if (number > 0) {
      pen.beginPath();
      pen.moveTo(x, up(1) - 14);
      pen.lineTo(x, up(0));
      pen.stroke();
    }
    if (pen.measureText(words).width + 6 < room) pen.fillText(words, x + 3, 13);
  });
  pen.setLineDash([]);
}

function curve(pen, hue, rates, neuron, across, up) {
  if (!rates.length) return;
  pen.strokeStyle = hue;
  pen.lineWidth = 1.8;
  pen.lineJoin = "round";
  pen.beginPath();
  rates.forEach((all, step) => {
    if (step === 0) pen.moveTo(across(0), up(all[neuron]));
    else pen.lineTo(across(step), up(all[neuron]));
  });
  pen.stroke();
}
