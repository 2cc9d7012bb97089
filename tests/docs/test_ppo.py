"""The example that learns with Stable-Baselines3, where that is installed (CI has no PyTorch).

What the vector of worlds gives it is tested without: `tests/arm2d/worlds/test_environment.py`.
"""

import runpy
import sys
from pathlib import Path

import numpy as np
import pytest

EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "ppo.py"
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def ppo():
    for name in ("stable_baselines3", "sb3_contrib"):
        pytest.importorskip(name, reason="the example needs the extra rl, 900 MB: pip install 'wordarm[rl]'")
    return runpy.run_path(str(EXAMPLE))


def learn(monkeypatch, *flags):
    monkeypatch.setattr(sys, "argv", [str(EXAMPLE), *map(str, flags)])
    runpy.run_path(str(EXAMPLE), run_name="__main__")


def test_the_adapter_passes_on_what_the_worlds_give(ppo, tmp_path):
    training = ppo["Training"](tmp_path, memory="none")
    vector, twin = ppo["Worlds"](training), ppo["Worlds"](training).worlds
    vector.seed(5)
    first, _ = twin.reset(seed=5)
    assert np.array_equal(vector.reset(), first.astype(np.float32))
    rng, ended = np.random.default_rng(1), 0
    for _ in range(260):
        actions = rng.integers(0, 3, (vector.num_envs, 2))
        inputs, rewards, over, infos = vector.step(actions)
        due = twin.step(actions)
        assert np.array_equal(inputs, due[0].astype(np.float32))
        assert np.array_equal(rewards, due[1].astype(np.float32))
        assert np.array_equal(over, due[2])
        for i, info in enumerate(infos):
            assert bool(info) == over[i]
            if info:
                ended += 1
                assert np.array_equal(info["terminal_observation"], due[4]["final_obs"][i].astype(np.float32))
    assert ended >= vector.num_envs


def test_the_leaky_memory_is_of_the_trial_under_way(ppo, tmp_path):
    vector = ppo["Worlds"](ppo["Training"](tmp_path, memory="leaky"))
    vector.seed(5)
    shown = vector.reset()
    sensed, averages = shown[:, :12].astype(float), shown[:, 18:].reshape(-1, 2, 12)
    assert np.array_equal(averages, np.repeat(shown[:, np.newaxis, :12], 2, axis=1))
    expected, rng, ended = np.repeat(sensed[:, np.newaxis], 2, axis=1), np.random.default_rng(1), 0
    rates = np.array([0.1 / 1.0, 0.1 / 5.0])[:, np.newaxis]
    for _ in range(260):
        shown, _, over, infos = vector.step(rng.integers(0, 3, (vector.num_envs, 2)))
        last = np.array(
            [info.get("terminal_observation", own) for info, own in zip(infos, shown, strict=True)]
        )
        expected += rates * (last[:, np.newaxis, :12].astype(float) - expected)
        # Inputs reach the policy rounded to 24 bits.
        np.testing.assert_allclose(last[:, 18:], expected.reshape(len(last), -1), atol=1e-5)
        expected[over] = shown[over, np.newaxis, :12]
        np.testing.assert_allclose(shown[:, 18:], expected.reshape(len(last), -1), atol=1e-5)
        ended += over.sum()
    assert ended >= vector.num_envs


@pytest.mark.parametrize("memory", ["leaky", "lstm", "none"])
def test_learning_goes_on_from_what_was_stored(ppo, memory, tmp_path, monkeypatch, capsys):
    learn(monkeypatch, tmp_path / "once", "--steps", 30_000, "--memory", memory)
    assert "MOVE Blue" in capsys.readouterr().out
    training = ppo["Training"](tmp_path / "once", memory=memory)
    model = ppo["new_model"](training, 0)
    ppo["load_policy"](model, tmp_path / "once" / "policy.npz")
    (curve,) = ppo["read_curves"](tmp_path / "once" / "curve.csv")
    assert curve.steps.tolist() == [0, model.num_timesteps]
    found = ppo["successes"](model, training, [training.seed, model.num_timesteps])
    assert found.tolist() == curve.successes[-1].tolist()
    ppo["save_policy"](model, tmp_path / "again.npz")
    with np.load(tmp_path / "once" / "policy.npz") as stored, np.load(tmp_path / "again.npz") as again:
        assert set(stored.files) == set(again.files)
        assert any(name.startswith("adam.") for name in stored.files)
        assert all(np.array_equal(stored[name], again[name]) for name in stored.files)

    learn(monkeypatch, tmp_path / "once", "--steps", 60_000, "--memory", memory)
    (longer,) = ppo["read_curves"](tmp_path / "once" / "curve.csv")
    assert longer.steps[:2].tolist() == curve.steps.tolist()
    assert longer.steps[-1] > curve.steps[-1]
    assert (np.diff(longer.cpu) > 0).all()


def test_a_folder_of_another_learner_is_refused(ppo, tmp_path):
    curve = ppo["LearningCurve"].empty("PPO, LSTM", ppo["arm2d"].Condition.WITH_INDICATE, 1)
    ppo["write_curves"](tmp_path / "curve.csv", [curve.longer(0, 0.0, [0] * 9)])
    with pytest.raises(SystemExit, match="holds PPO, LSTM, with-indicate, seed 1; choose another folder"):
        ppo["main"](ppo["Training"](tmp_path, seed=2))
