import { census } from "./census.js";
import { drawStart, generator } from "./starts.js";
import { scores } from "./judge.js";
import { inView } from "./camera.js";
