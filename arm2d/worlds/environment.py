"""The world as Gymnasium knows worlds (extra `gym`): learn the seven instructions, be asked all nine.

    import arm2d.worlds.environment                                  # registers the name
    world = gymnasium.make("wordarm/Instructions-v0")
    worlds = gymnasium.make_vec("wordarm/Instructions-v0", num_envs=4096)

An observation is the 18 inputs of spec section 4, an action two numbers from 0 to 2: turn one way, not
at all, or the other way, for S1 and S2. The return of an episode is the trial's F1 + F2 + F3.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar, Final

import gymnasium
import numpy as np
from gymnasium.spaces import Box, MultiDiscrete
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from arm2d.constants import N_INPUTS
from arm2d.instructions import Condition, Instruction
from arm2d.readings import Readings
from arm2d.tasks.task import AnyTask
from arm2d.video import Panel
from arm2d.worlds.asking import Asked, Reward, Source, turns_of
from arm2d.worlds.vector_world import VectorWorld
from arm2d.worlds.world import World

NAME: Final = "wordarm/Instructions-v0"
PICTURE_SIZE: Final = 480  # [pixels]


class InstructionsEnv(gymnasium.Env):
    """One trial an episode.

    Args:
        condition: "with-indicate", "with-ignore", "with-both", or an `arm2d.Task` of your own.
        instructions: What trials are drawn from: "experienced" (for training), "held-out", "all", or a list
            of the condition's instructions.
        readings: How the paper is understood.
        reward: "end", all of F1 + F2 + F3 with the last step, or "progress", what each step adds to it.
        render_mode: "rgb_array" or none.

    Raises:
        ValueError: If an argument is none of these.
    """

    metadata: ClassVar = {"render_modes": ["rgb_array"], "render_fps": 10}  # type: ignore[misc]
    observation_space = Box(0.0, 1.0, (N_INPUTS,), np.float64)
    action_space = MultiDiscrete([3, 3])

    def __init__(
        self,
        condition: AnyTask | str = Condition.WITH_INDICATE,
        instructions: Asked | Sequence[Instruction | str] = "experienced",
        readings: Readings | None = None,
        reward: Reward = "end",
        render_mode: str | None = None,
    ) -> None:
        self.source = Source(condition, instructions, readings, reward)
        self.reward, self.render_mode = reward, render_mode
        self.world = World(self.source.readings)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float64], dict[str, Any]]:
        """Begin a trial; `options["instruction"]` chooses what is asked, such as "touch green".

        Raises:
            ValueError: If the condition has no such instruction.
        """
        super().reset(seed=seed)
        start = self.source.first(1, self.np_random, options)
        self.instruction = start.instructions[0]
        inputs = self.world.reset(self.instruction, start=start)
        # What IGNORE is worth before anything has happened belongs to the first step's reward.
        self._paid = 0.0
        return inputs, {"instruction": str(self.instruction)}

    def step(
        self, action: NDArray[np.int64]
    ) -> tuple[NDArray[np.float64], float, bool, bool, dict[str, Any]]:
        """Turn both joints; terminated when the trial ends.

        Raises:
            ValueError: If the action is not two of 0, 1 and 2, or the trial is over.
        """
        inputs = self.world.step(turns_of(action, (2,)))
        ended, now = self.world.ended, self._now()
        info: dict[str, Any] = {"instruction": str(self.instruction)}
        reward = now - self._paid if ended or self.reward == "progress" else 0.0
        self._paid += reward
        if ended:
            info["success"] = bool(self.world.score().success[0, 0])
        return inputs, reward, ended, False, info

    def render(self) -> NDArray[np.uint8] | None:
        """The world as it is now, [480, 480, 3]."""
        if self.render_mode is None:
            return None
        record = self.world.record()
        panel = Panel(record, PICTURE_SIZE, PICTURE_SIZE, outcome=self.world.ended)
        return panel.frame(record.steps)

    def _now(self) -> float:
        return float(self.world.score().fitness[0, 0])


class InstructionsVectorEnv(VectorEnv):
    """N trials side by side, in the compiled world; those that have ended begin anew.

    Args:
        num_envs: N.
        condition: As `InstructionsEnv`; so are
        instructions: what is asked,
        readings: the world, and
        reward: when it is paid.
        autoreset_mode: When another trial begins: with the next step, which pays nothing, or with the step
            that ends one. Then `final_obs` in the information is what was sensed last.

    Raises:
        ValueError: If an argument is none of these, or ended trials should not begin anew.
    """

    single_observation_space = InstructionsEnv.observation_space
    single_action_space = InstructionsEnv.action_space

    def __init__(
        self,
        num_envs: int = 1,
        condition: AnyTask | str = Condition.WITH_INDICATE,
        instructions: Asked | Sequence[Instruction | str] = "experienced",
        readings: Readings | None = None,
        reward: Reward = "end",
        autoreset_mode: AutoresetMode = AutoresetMode.NEXT_STEP,
    ) -> None:
        if autoreset_mode is AutoresetMode.DISABLED:
            raise ValueError("trials that have ended begin anew; choose AutoresetMode.NEXT_STEP or SAME_STEP")
        self.metadata = {"autoreset_mode": autoreset_mode}
        self._at_once = autoreset_mode is AutoresetMode.SAME_STEP
        self.num_envs = num_envs
        self.source, self.reward = Source(condition, instructions, readings, reward), reward
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float64], dict[str, Any]]:
        """Begin N trials; `options["instruction"]` chooses what they ask, not what those begun later ask.

        Raises:
            ValueError: If the condition has no such instruction.
        """
        super().reset(seed=seed)
        start = self.source.first(self.num_envs, self.np_random, options)
        self.world = VectorWorld(start, self.source.readings)
        self._over, self._paid = np.zeros(self.num_envs, np.bool_), np.zeros(self.num_envs)
        return self.world.inputs.copy(), {}

    def step(
        self, actions: NDArray[np.int64]
    ) -> tuple[
        NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]
    ]:
        """Turn the joints of all trials; those that have ended begin anew, at once or instead.

        Raises:
            ValueError: If the actions are not N pairs of 0, 1 and 2.
        """
        began = np.flatnonzero(self._over)
        self.world.step(turns_of(actions, (self.num_envs, 2)))
        self._begin(began)
        over = self.world.ended
        rewards, info = np.zeros(self.num_envs), {}
        if over.any() or self.reward == "progress":
            scores = self.world.scores()
            paying = np.ones_like(over) if self.reward == "progress" else over.copy()
            paying[began] = False
            rewards[paying] = scores.fitness[0, paying] - self._paid[paying]
            self._paid += rewards
            info = {"success": scores.success[0] & over, "_success": over.copy()}
        if self._at_once and over.any():
            info |= {"final_obs": self.world.inputs.copy(), "_final_obs": over.copy()}
            self._begin(np.flatnonzero(over))
        self._over = self.world.ended
        return self.world.inputs.copy(), rewards, over, np.zeros_like(over), info

    def _begin(self, which: NDArray[np.int64]) -> None:
        """Draw other trials in the place of some."""
        if len(which):
            self.world.restart(which, self.source.draw(len(which), self.np_random))
            self._paid[which] = 0.0


gymnasium.register(
    NAME,
    entry_point="arm2d.worlds.environment:InstructionsEnv",
    vector_entry_point="arm2d.worlds.environment:InstructionsVectorEnv",
)
