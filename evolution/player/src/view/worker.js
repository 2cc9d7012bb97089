// Counting successes beside the page, so that the arm goes on moving meanwhile.

import { census } from "../world/census.js";

/** In the worker: answer an order with one message for every instruction, and then `null`. */
export function answerOrders(scope) {
  scope.onmessage = ({ data }) => {
    for (const row of census(data)) scope.postMessage(row);
    scope.postMessage(null);
  };
}

/**
 * In the page: let a worker count.
 *
 * @param script Text of the page's own script; a page opened from disk has no file to load a worker from.
 * @param onRow Called with every { instruction, successes }.
 * @returns A promise that is kept when all nine are counted.
 */
export function count(script, order, onRow) {
  const address = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
  const worker = new Worker(address);
  return new Promise((keep, refuse) => {
    worker.onmessage = ({ data }) => (data === null ? keep() : onRow(data));
    worker.onerror = (event) => refuse(new Error(event.message || "the browser refused to start a worker"));
    worker.postMessage(order);
  }).finally(() => {
    worker.terminate();
    URL.revokeObjectURL(address);
  });
}
