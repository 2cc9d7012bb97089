// Appended to the page's own script by test_same_bits.py: reads trials, runs them, writes every step.
// One row of 34 doubles for the start and for every step: alpha, beta, turned, bent, three states, bearings and distances of the three
// discs, their sides, 18 inputs; then one row of outcomes a trial: F1, F2, F3, success, steps.

const fs = require("node:fs");
const [, , jobsFile, stepsFile, outcomesFile] = process.argv;
const jobs = JSON.parse(fs.readFileSync(jobsFile, "utf8"));

/** The instruction heard next, where the words change `delay` steps after the target came into view. */
function listener(world, { instruction, changes }) {
  if (!changes) return () => instruction;
  let wait = null;
  let heard = changes.first;
  return (state) => {
    if (state.fresh) return heard;
    if (wait !== null) wait -= 1;
    else if (wordarm.inView(world, state.alpha, state.discs[instruction.object])) wait = changes.delay;
    if (wait === 0) heard = changes.later;
    return heard;
  };
}

function rowOf(state) {
  const { alpha, beta, turned, bent, y, discs, inputs = new Array(18).fill(0) } = state;
  const of = (name) => discs.map((disc) => disc[name]);
  return [alpha, beta, turned, bent, ...y, ...of("bearing"), ...of("distance"), ...of("side"), ...inputs];
}

const steps = [];
const outcomes = [];
for (const job of jobs) {
  const world = wordarm.worldOf(job.readings);
  const agent = wordarm.creature(wordarm.decode(job.genotype, job.readings), world);
  const listen = listener(world, job);
  let state = wordarm.begin(agent, job.start, job.instruction);
  steps.push(rowOf(state));
  while (!state.judged.done) {
    state = wordarm.step(agent, state, listen(state));
    steps.push(rowOf(state));
  }
  const { f1, f2, f3, success } = wordarm.scores(world, state);
  outcomes.push([f1, f2, f3, success ? 1 : 0, state.judged.steps]);
}
fs.writeFileSync(stepsFile, new Float64Array(steps.flat()));
fs.writeFileSync(outcomesFile, new Float64Array(outcomes.flat()));
