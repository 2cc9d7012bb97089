// Appended to the page's own script by test_player.py: what the reader's hand does to a trial, as JSON.

const fs = require("node:fs");
const agents = JSON.parse(fs.readFileSync(process.argv[2], "utf8"));
const [agent] = agents;
const world = wordarm.worldOf(agent.readings);
const start = wordarm.drawStart(world, 0, wordarm.generator(1));
const touchRed = { action: 1, object: 2 };
const moveRed = { action: 0, object: 2 };

const whole = (session) => wordarm.advanced(session, 1000);
const plain = (session) => session.states.map(({ alpha, beta, y }) => [alpha, beta, ...y]);
const verdictOf = (session) => wordarm.verdict(world, wordarm.last(session), false).text;
const opened = () => wordarm.open(agent, start, touchRed);

const calm = whole(opened());
const k = 80;
const changed = whole(wordarm.told(calm, k, moveRed));
const unmoved = wordarm.moved(calm, 5, 0, [120, -60]);
const silenced = (part) => ({ action: false, object: false, neurons: [false, false, false], ...part });

const found = {
  calm: verdictOf(calm),
  sameBefore: JSON.stringify(plain(changed).slice(0, k + 1)) === JSON.stringify(plain(calm).slice(0, k + 1)),
  changed: verdictOf(changed),
  again: JSON.stringify(plain(whole(wordarm.rewound(changed)))) === JSON.stringify(plain(whole(wordarm.open(agent, start, moveRed)))),
  dropped: unmoved.states.length,
  blueAt: unmoved.states[5].discs[0].bearing,
  unended: wordarm.progress({ ...world, ignoreStops: false }, { judged: { action: 3, run: 50 } }),
  paused: wordarm.progress(world, { judged: { action: 1, run: 25, good: false } }),
  ended: [
    { action: 3, object: 0, best: 100, alpha: 30, beta: 90 },
    { action: 2, object: 0, best: 100, alpha: 60, beta: 90 },
    { action: 1, object: 0, best: 100, alpha: 30, beta: 30 },
    { action: 1, object: 0, best: 99, alpha: 30, beta: 30 },
  ].map(({ alpha, beta, ...judged }) => {
    const disc = { bearing: 30, low: 30, high: 30, distance: 150, side: 0 };
    const state = { alpha, beta, discs: [disc, { ...disc, bearing: 90 }, { ...disc, bearing: 150 }] };
    const whole = { firstOffset: 60, excused: [], steps: 250, collided: false, done: true, ...judged };
    return wordarm.verdict({ ...world, strictSuccess: true }, { ...state, judged: whole }, false).text;
  }),
  deaf: wordarm.sense({ world, silenced: silenced({ object: true }) }, calm.states[0], touchRed).slice(12),
  mute: whole(wordarm.open(agent, start, touchRed, silenced({ neurons: [false, true, false] }))).states.map((s) => s.z[1]),
  third: wordarm.translated({ action: 2, object: 0 }, "with-ignore"),
  counts: agents.map(({ genotype, readings, condition }) =>
    [...wordarm.census({ genotype, readings, condition, silenced: silenced({}), seed: 3 })].map((row) => row.successes),
  ),
};

const draw = wordarm.generator(3);
found.starts = Array.from({ length: 720 }, (_, trial) => wordarm.drawStart(world, trial % 80 < 40 ? 0 : 1, draw));
console.log(JSON.stringify(found));
