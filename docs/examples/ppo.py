"""The seven instructions learnt by gradients: PPO of Stable-Baselines3, with one of two memories or none.

    pip install -c constraints.txt '.[rl]'
    python docs/examples/ppo.py FOLDER --steps 8_000_000 --seed 1

FOLDER gets the learning curve (curve.csv, curve.png, curve.svg) and the policy (policy.npz). Given again, the
command goes on from there. Training meets the seven experienced instructions; all nine are only tested.
"""

import io
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import gymnasium
import numpy as np
import torch
import tyro
from gymnasium.spaces import Box
from gymnasium.vector import AutoresetMode
from sb3_contrib import RecurrentPPO
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import VecEnv

import arm2d
from arm2d.files import write_whole
from arm2d.worlds.environment import NAME
from evolution.figures.learning import learning_figure
from evolution.figures.page import save_figure
from evolution.results.learning import TRIALS, LearningCurve, read_curves, write_curves

# The plain readings: the world in which docs/how-to/reinforcement-learning.md compares.
READINGS = arm2d.Readings.preset("plain")
N_WORLDS = 128
# The leaky memory: averages of the first 12 inputs (touch, camera, elbow) over so long [s].
N_SENSED, SPANS = 12, (1.0, 5.0)
TESTS = 40  # over the whole of a training
# One rollout is 256 steps of 128 worlds: longer than a trial. The rest are usual values for PPO.
SETTINGS = {
    "n_steps": 256, "batch_size": 4096, "n_epochs": 6, "gamma": 0.99, "ent_coef": 0.002, "device": "cpu",
}  # fmt: skip
LARGEST_RATE = 1e-3  # of learning; falls to 0 by the end
LEARNERS = {"leaky": "PPO, leaky memory", "lstm": "PPO, LSTM", "none": "PPO, no memory"}


@dataclass(frozen=True)
class Training:
    """Learn seven instructions with Stable-Baselines3.

    Attributes:
        folder: Where curve and policy go; given again, learning goes on.
        steps: Steps of a trial to learn from.
        seed: Of weights, trials and decisions.
        memory: Leaky averages of what is sensed, or none, before two layers of 64 (PPO); or an LSTM of 64
            cells (RecurrentPPO).
        reward: What each step adds to the score ("progress"), or all of it with the last step ("end").
        condition: Which instructions there are.
    """

    folder: Annotated[Path, tyro.conf.Positional]
    steps: int = 8_000_000
    seed: int = 1
    memory: Literal["leaky", "lstm", "none"] = "leaky"
    reward: Literal["progress", "end"] = "progress"
    condition: Literal["with-indicate", "with-ignore"] = "with-indicate"


class Sight:
    """What the policies of N worlds are shown: the inputs, and leaky averages of those that are sensed."""

    def __init__(self, training, n):
        spans = SPANS if training.memory == "leaky" else ()
        self.rates = np.array([[arm2d.constants.DT / span] for span in spans]).reshape(-1, 1)
        self.averages = np.zeros((n, len(spans), N_SENSED))

    def first(self, inputs, which):
        """[N, 18 + averages], as some trials begin."""
        self.averages[which] = inputs[which, np.newaxis, :N_SENSED]
        return self._joined(inputs)

    def next(self, inputs):
        """The same a step later."""
        self.averages += self.rates * (inputs[:, np.newaxis, :N_SENSED] - self.averages)
        return self._joined(inputs)

    def _joined(self, inputs):
        return np.concatenate([inputs, self.averages.reshape(len(inputs), -1)], axis=1, dtype=np.float32)


class Worlds(VecEnv):
    """The compiled vector of worlds as Stable-Baselines3 wants it."""

    def __init__(self, training):
        how = {"condition": training.condition, "reward": training.reward}
        same_step = AutoresetMode.SAME_STEP
        self.worlds = gymnasium.make_vec(
            NAME, num_envs=N_WORLDS, autoreset_mode=same_step, readings=READINGS, **how
        )
        self.sight = Sight(training, N_WORLDS)
        shown = Box(0.0, 1.0, (18 + self.sight.averages[0].size,), np.float32)
        super().__init__(N_WORLDS, shown, self.worlds.single_action_space)

    def reset(self):
        """The inputs of new trials."""
        inputs, _ = self.worlds.reset(seed=self._seeds[0])
        self._reset_seeds()
        return self.sight.first(inputs, np.ones(N_WORLDS, bool))

    def step_async(self, actions):
        """Take the actions of all worlds ..."""
        self.actions = actions

    def step_wait(self):
        """... and carry them out; a trial that ends makes room for another one at once."""
        inputs, rewards, over, _, info = self.worlds.step(self.actions)
        last, infos = self.sight.next(info.get("final_obs", inputs)), [{}] * N_WORLDS
        for i in np.flatnonzero(over):
            infos[i] = {"terminal_observation": last[i]}
        return self.sight.first(inputs, over), rewards.astype(np.float32), over, infos

    def close(self):
        """Nothing is open."""
        self.worlds.close()

    def get_attr(self, name, indices=None):
        """What the vector knows, for every world."""
        return [getattr(self.worlds, name, None)] * N_WORLDS

    def env_is_wrapped(self, wrapper_class, indices=None):
        """No world is."""
        return [False] * N_WORLDS

    def set_attr(self, name, value, indices=None):
        """Refused."""
        raise NotImplementedError("all worlds are one; make another vector instead")

    def env_method(self, name, *args, indices=None, **kwargs):
        """Refused."""
        raise NotImplementedError("all worlds are one; call the vector's own methods")


def new_model(training, steps):
    """A learner with random weights; `steps` were made before."""
    rate = {"learning_rate": lambda left: LARGEST_RATE * left, "seed": training.seed + steps}
    if training.memory != "lstm":
        return PPO("MlpPolicy", Worlds(training), policy_kwargs={"net_arch": [64, 64]}, **SETTINGS, **rate)
    shape = {"net_arch": [], "lstm_hidden_size": 64, "shared_lstm": True, "enable_critic_lstm": False}
    return RecurrentPPO("MlpLstmPolicy", Worlds(training), policy_kwargs=shape, **SETTINGS, **rate)


def successes(model, training, seed):
    """Of 80 fresh trials of each of the nine instructions, how many succeed, [9]; the likeliest actions."""
    asked = arm2d.Condition(training.condition).instructions
    rng = np.random.default_rng(seed)
    world = arm2d.VectorWorld(arm2d.draw_trials(asked, TRIALS // 2, READINGS, rng))
    sight, state, began = Sight(training, len(world)), None, np.ones(len(world), bool)
    shown = sight.first(world.inputs, began)
    while not world.ended.all():
        actions, state = model.predict(shown, state, began, deterministic=True)
        shown = sight.next(world.step(actions - 1))
        began[:] = False
    return world.scores().success[0].reshape(len(asked), -1).sum(axis=1)


class Tests(BaseCallback):
    """Tests the policy from time to time, and stores what it has come to; tests do not count as CPU time."""

    def __init__(self, training, curve):
        super().__init__()
        self.training, self.curve = training, curve
        self.before, self.began = (curve.cpu[-1] if len(curve) else 0.0), time.process_time()

    def _on_step(self):
        return True

    def _on_rollout_start(self):
        if self.num_timesteps >= len(self.curve) / TESTS * self.training.steps:
            self.test()

    def _on_training_end(self):
        self.test()

    def test(self):
        """Append to the curve, say how it stands, store everything."""
        if len(self.curve) and self.num_timesteps == self.curve.steps[-1]:
            return  # learning went on from here
        cpu = self.before + time.process_time() - self.began
        training, steps = self.training, self.num_timesteps
        found = successes(self.model, training, [training.seed, steps])
        self.curve = self.curve.longer(steps, cpu, found)
        seven, never_met = self.curve.experienced[-1], self.curve.held_out[-1].mean()
        print(
            f"{steps:12,} steps {cpu:6.0f} s CPU: seven {seven:4.0%}, never met {never_met:4.0%}", flush=True
        )
        save_policy(self.model, training.folder / "policy.npz")
        write_curves(training.folder / "curve.csv", [self.curve])
        self.before, self.began = cpu, time.process_time()


def save_policy(model, path):
    """Weights, and what the optimiser has seen, as plain arrays."""
    arrays = {f"weights.{name}": value for name, value in model.policy.state_dict().items()}
    for number, moments in model.policy.optimizer.state_dict()["state"].items():
        arrays |= {f"adam.{number}.{name}": value for name, value in moments.items()}
    file = io.BytesIO()
    np.savez(file, steps=model.num_timesteps, **{name: value.numpy() for name, value in arrays.items()})
    write_whole(path, file.getvalue())


def load_policy(model, path):
    """The other way round."""
    with np.load(path, allow_pickle=False) as stored:
        arrays = {name: torch.from_numpy(stored[name]) for name in stored.files}
    model.num_timesteps = int(arrays.pop("steps"))
    optimizer = model.policy.optimizer.state_dict()
    for name in [name for name in arrays if name.startswith("adam.")]:
        _, number, moment = name.split(".")
        optimizer["state"].setdefault(int(number), {})[moment] = arrays.pop(name)
    model.policy.load_state_dict({name.removeprefix("weights."): value for name, value in arrays.items()})
    model.policy.optimizer.load_state_dict(optimizer)


def main(training):
    """Learn, or go on learning; draw the curve, print the last test."""
    torch.set_num_threads(1)
    condition, learner = arm2d.Condition(training.condition), LEARNERS[training.memory]
    curve = LearningCurve.empty(learner, condition, training.seed)
    training.folder.mkdir(parents=True, exist_ok=True)
    if (training.folder / "curve.csv").exists():
        (curve,) = read_curves(training.folder / "curve.csv")
        if (curve.learner, curve.condition, curve.seed) != (learner, condition, training.seed):
            found = f"{curve.learner}, {curve.condition}, seed {curve.seed}"
            raise SystemExit(f"{training.folder} holds {found}; choose another folder")
    model = new_model(training, int(curve.steps[-1]) if len(curve) else 0)
    if len(curve):
        load_policy(model, training.folder / "policy.npz")
    tests = Tests(training, curve)
    model.learn(training.steps - model.num_timesteps, callback=tests, reset_num_timesteps=False)
    for instruction, count in zip(map(str, condition.instructions), tests.curve.successes[-1], strict=True):
        print(f"{instruction:14} {count} of {TRIALS}")
    save_figure(learning_figure([tests.curve]), training.folder / "curve")


if __name__ == "__main__":
    main(tyro.cli(Training))
