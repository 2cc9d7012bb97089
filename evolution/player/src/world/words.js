// The words, how they sound to the agent, and the two instructions no agent ever practised.

/** Code of an action word: its place here. */
export const ACTIONS = ["MOVE", "TOUCH", "INDICATE", "IGNORE"];
/** Code of an object word, and index of the object: its place here. */
export const OBJECTS = ["Blue", "Green", "Red"];

const ACTION_CODES = [
  [0, 1, 1],
  [1, 0, 1],
  [1, 1, 0],
  [1, 1, 0],
];
const OBJECT_CODES = [
  [1, 1, 0],
  [1, 0, 1],
  [0, 1, 1],
];
const SILENCE = [0, 0, 0];

/** The six inputs of an instruction { action, object }; a silenced word is three zeros. */
export function hear(instruction, silenced) {
  const object = silenced.object ? SILENCE : OBJECT_CODES[instruction.object];
  const action = silenced.action ? SILENCE : ACTION_CODES[instruction.action];
  return [...object, ...action];
}

/** Whether the instruction was held out of evolution: MOVE Blue and TOUCH Green were. */
export function neverMet({ action, object }) {
  return (action === 0 && object === 0) || (action === 1 && object === 1);
}

/** The three action codes of a condition. */
export function actionsOf(condition) {
  return [0, 1, condition === "with-ignore" ? 3 : 2];
}

/** The nine instructions of a condition, action by action. */
export function instructionsOf(condition) {
  return actionsOf(condition).flatMap((action) => [0, 1, 2].map((object) => ({ action, object })));
}

/** An instruction as people read it. */
export function spoken({ action, object }) {
  return `${ACTIONS[action]} ${OBJECTS[object]}`;
}
