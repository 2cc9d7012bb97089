// Where the script begins: in the page it starts the players, in a worker it counts.

import { makePlayer } from "./view/player.js";
import { answerOrders } from "./view/worker.js";

const SCRIPT = "wordarm-script";
let players = 0;

/** Start every player of the page. */
export function startPlayers() {
  const script = document.getElementById(SCRIPT).textContent;
  const template = document.getElementById("wordarm-player");
  for (const root of document.querySelectorAll(".wordarm")) {
    const agents = JSON.parse(root.querySelector("script").textContent);
    root.append(withOwnNames(template.content.cloneNode(true)));
    const player = makePlayer(root, agents, script);
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (root.hasAttribute("data-autoplay") && !still) player.find("play").click();
  }
}

/** A copy of the template whose ids no other copy has. */
function withOwnNames(fragment) {
  const own = `wa-keys-${(players += 1)}`;
  fragment.getElementById("wa-keys").id = own;
  fragment.querySelector(".wa-stage").setAttribute("aria-describedby", own);
  return fragment;
}

if (typeof document !== "undefined") startPlayers();
else if (typeof WorkerGlobalScope !== "undefined") answerOrders(self);
