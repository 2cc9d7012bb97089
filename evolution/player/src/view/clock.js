// Playing: a place in the trial that moves on with the time.

import { DT } from "../world/world.js";

/**
 * A clock that calls `onTick(steps)` with the control steps, whole and part, that have passed since.
 *
 * @param speed Gives how many times faster than life it runs.
 */
export function makeClock(speed, onTick) {
  let before = null;
  const tick = (now) => {
    if (before === null) return;
    // A frame may have begun before the click that it answers; a page that was hidden does not catch up.
    const passed = Math.min(0.25, Math.max(0, (now - before) / 1000));
    before = now;
    onTick((passed * speed()) / DT);
    if (before !== null) requestAnimationFrame(tick);
  };
  return {
    get runs() {
      return before !== null;
    },
    start() {
      if (before !== null) return;
      before = performance.now();
      requestAnimationFrame(tick);
    },
    stop() {
      before = null;
    },
  };
}
