"""The world as Gymnasium knows worlds: its checker passes, returns are fitness, both kinds agree."""

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

from arm2d import NON_EXPERIENCED, Condition, Instruction, Readings, Task
from arm2d.worlds.asking import asked_instructions
from arm2d.worlds.environment import NAME


@pytest.mark.parametrize("reward", ["end", "progress"])
def test_gymnasiums_own_checker_finds_nothing(reward):
    world = gymnasium.make(NAME, reward=reward, render_mode="rgb_array", disable_env_checker=True)
    check_env(world.unwrapped)


@pytest.mark.parametrize("reward", ["end", "progress"])
@pytest.mark.parametrize("condition", list(Condition))
def test_the_return_of_an_episode_is_the_trials_fitness(condition, reward):
    world = gymnasium.make(NAME, condition=condition, reward=reward)
    world.action_space.seed(1)
    for seed in range(12):
        world.reset(seed=seed)
        total, ended = 0.0, False
        while not ended:
            _, paid, ended, truncated, info = world.step(world.action_space.sample())
            total += paid
            assert not truncated
        score = world.unwrapped.world.score()
        assert total == pytest.approx(float(score.fitness[0, 0]), abs=1e-12)
        assert info["success"] == bool(score.success[0, 0])


@pytest.mark.parametrize("reward", ["end", "progress"])
def test_a_vector_of_worlds_pays_what_single_worlds_pay(reward):
    """Episodes of the vector, each done again by itself from the start that the vector drew."""
    n, rng = 50, np.random.default_rng(4)
    worlds = gymnasium.make_vec(NAME, num_envs=n, reward=reward)
    worlds.reset(seed=3)
    vector = worlds.unwrapped.world
    trials, single = vector.trials, gymnasium.make(NAME, reward=reward).unwrapped
    totals, over, actions = np.zeros(n), np.zeros(n, bool), []
    while not over.all():
        actions.append(rng.integers(0, 3, (n, 2)))
        _, rewards, ended, _, _ = worlds.step(actions[-1])
        totals += np.where(over, 0.0, rewards)
        over |= ended
    for t in range(n):
        single.reset(seed=0)
        single.world.reset(trials.instructions[t], start=trials[t])
        single._paid, total, ended = 0.0, 0.0, False
        for action in actions:
            _, paid, ended, _, _ = single.step(action[t])
            total += paid
            if ended:
                break
        assert ended
        assert totals[t] == pytest.approx(total, abs=1e-12)


def test_a_vectors_spaces_hold_what_it_takes_and_gives():
    worlds = gymnasium.make_vec(NAME, num_envs=4).unwrapped
    for space in (worlds.observation_space, worlds.action_space):
        space.seed(1)
    observations, _ = worlds.reset(seed=1)
    assert worlds.num_envs == 4
    assert worlds.observation_space.shape == observations.shape == (4, 18)
    assert worlds.action_space.shape == (4, 2)
    for _ in range(20):
        assert worlds.observation_space.contains(observations)
        observations, rewards, ended, cut, _ = worlds.step(worlds.action_space.sample())
        assert rewards.shape == ended.shape == cut.shape == (4,)


def test_a_trial_that_ended_begins_anew_with_the_next_step():
    worlds = gymnasium.make_vec(NAME, num_envs=40, reward="progress")
    observations, _ = worlds.reset(seed=5)
    ended = np.zeros(40, bool)
    seen = 0
    for _ in range(600):
        before = ended
        observations, rewards, ended, _, _ = worlds.step(np.full((40, 2), 1))
        assert not ended[before].any()
        assert np.all(rewards[before] == 0.0)
        assert np.all(observations[before, 11] == 1.0)  # beta is 90 degrees again
        seen += before.sum()
    assert seen >= 80


@pytest.mark.parametrize("reward", ["end", "progress"])
def test_beginning_anew_at_once_pays_every_trial_what_a_single_world_pays_for_it(reward):
    """Every trial that the vector draws in 510 steps, done again by itself with the actions it had there."""
    n, rng = 20, np.random.default_rng(4)
    worlds = gymnasium.make_vec(NAME, num_envs=n, reward=reward, autoreset_mode=AutoresetMode.SAME_STEP)
    single, ended_trials = gymnasium.make(NAME, reward=reward).unwrapped, 0
    worlds.reset(seed=3)
    trials = worlds.unwrapped.world.trials
    under_way = [(trials[i], []) for i in range(n)]
    for _ in range(510):
        actions = rng.integers(0, 3, (n, 2))
        observations, rewards, over, truncated, info = worlds.step(actions)
        assert not truncated.any()
        assert ("final_obs" in info) == over.any()
        trials = worlds.unwrapped.world.trials
        for i in range(n):
            start, made = under_way[i]
            made.append((actions[i], rewards[i]))
            if not over[i]:
                continue
            single.reset(seed=0)
            single.world.reset(start.instructions[0], start=start)
            single._paid = 0.0
            for action, paid in made:
                inputs, due, ended, _, one = single.step(action)
                assert paid == pytest.approx(due, abs=1e-12)
            assert ended
            assert info["success"][i] == one["success"]
            assert np.array_equal(info["final_obs"][i], inputs)
            # The next trial: S2 bent, the words of what it asks for.
            under_way[i], ended_trials = (trials[i], []), ended_trials + 1
            assert observations[i, 11] == 1.0
            assert np.array_equal(
                observations[i], single.world.reset(trials.instructions[i], start=trials[i])
            )
    assert ended_trials >= 2 * n


def test_trials_that_never_begin_anew_are_refused():
    with pytest.raises(ValueError, match="NEXT_STEP or SAME_STEP"):
        gymnasium.make_vec(NAME, num_envs=2, autoreset_mode=AutoresetMode.DISABLED)


def test_training_never_meets_what_is_held_out():
    for condition in Condition:
        assert not set(asked_instructions(condition, "experienced")) & set(NON_EXPERIENCED)
        assert set(asked_instructions(condition, "held-out")) == set(NON_EXPERIENCED)
        assert asked_instructions(condition, "all") == condition.instructions
    worlds = gymnasium.make_vec(NAME, num_envs=2000)
    worlds.reset(seed=1)
    trials = worlds.unwrapped.world.trials
    assert set(trials.instructions) == set(Condition.WITH_INDICATE.experienced)
    assert 0.45 < (trials.alpha < 90.0).mean() < 0.55  # from the right as often as from the left


def test_the_same_seed_gives_the_same_episodes():
    def episode(seed):
        worlds = gymnasium.make_vec(NAME, num_envs=30)
        observations, _ = worlds.reset(seed=seed)
        rng = np.random.default_rng(1)
        return np.array([observations, *(worlds.step(rng.integers(0, 3, (30, 2)))[0] for _ in range(300))])

    assert np.array_equal(episode(7), episode(7))
    assert not np.array_equal(episode(7), episode(8))


def test_an_instruction_can_be_asked_for_and_is_drawn_in_the_picture():
    world = gymnasium.make(NAME, render_mode="rgb_array")
    inputs, info = world.reset(seed=1, options={"instruction": "touch green"})
    assert info["instruction"] == "TOUCH Green"
    assert inputs[12:].tolist() == [1, 0, 1, 1, 0, 1]
    first = world.render()
    assert first.shape == (480, 480, 3)
    for _ in range(10):
        world.step([2, 1])
    assert (world.render() != first).any()


def test_what_cannot_be_asked_is_refused_with_what_can():
    with pytest.raises(ValueError, match="experienced, held-out, all"):
        asked_instructions(Condition.WITH_INDICATE, "some")
    with pytest.raises(ValueError, match="unknown object word"):
        asked_instructions(Condition.WITH_INDICATE, ["touch yellow"])
    assert asked_instructions(Condition.WITH_INDICATE, ["move red"]) == (Instruction.parse("move red"),)


MAKERS = [gymnasium.make, gymnasium.make_vec]


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"reward": "progres"}, "reward = 'progres'; choose end or progress"),
        ({"reward": ["end"]}, r"reward = \['end'\]; choose end or progress"),
        ({"instructions": ["ignore red"]}, "with-indicate has no instruction IGNORE Red; it has MOVE Blue, "),
        ({"instructions": ["move red"], "condition": "with-grasp"}, "unknown condition 'with-grasp'"),
        ({"instructions": []}, "asked for an empty list of instructions; give at least one"),
        ({"instructions": 5}, "5 is no instruction; give text such as 'touch green'"),
        ({"readings": "plain"}, "readings = 'plain' must be a record"),
    ],
)
def test_what_an_environment_cannot_be_made_of_is_refused_at_once(make, arguments, sentence):
    with pytest.raises(ValueError, match=sentence):
        make(NAME, **arguments)


@pytest.mark.parametrize("make", MAKERS)
def test_instructions_may_be_records_and_an_own_tasks(make):
    task = Task(third="both")
    worlds = make(NAME, condition=task, instructions=[Instruction.parse("ignore red"), "indicate red"])
    assert worlds.unwrapped.source.instructions == (task.instructions[11], task.instructions[8])


@pytest.mark.parametrize("make", MAKERS)
def test_an_instruction_that_the_condition_does_not_have_cannot_be_asked_for(make):
    worlds = make(NAME)
    for asked, sentence in {
        "ignore green": "with-indicate has no instruction IGNORE Green",
        5: "5 is no",
    }.items():
        with pytest.raises(ValueError, match=sentence):
            worlds.reset(seed=1, options={"instruction": asked})


def test_the_first_trials_of_a_vector_ask_what_is_asked_for_from_the_starts_drawn_otherwise():
    worlds = gymnasium.make_vec(NAME, num_envs=30)
    inputs, _ = worlds.reset(seed=1)
    drawn = worlds.unwrapped.world.trials
    for asked in ("touch green", Instruction.parse("touch green")):
        inputs, _ = worlds.reset(seed=1, options={"instruction": asked})
        trials = worlds.unwrapped.world.trials
        assert set(map(str, trials.instructions)) == {"TOUCH Green"}
        assert np.array_equal(trials.alpha, drawn.alpha)
        assert np.array_equal(trials.discs, drawn.discs)
        assert inputs[:, 12:].tolist() == [[1, 0, 1, 1, 0, 1]] * 30
    for _ in range(252):
        worlds.step(np.ones((30, 2), int))
    assert set(worlds.unwrapped.world.trials.instructions) <= set(Condition.WITH_INDICATE.experienced)


@pytest.mark.parametrize(
    ("action", "sentence"),
    [
        ([5, 1], "an action of 5 was given; each is 0, 1 or 2, for a turn of -1, 0 or 1"),
        ([1, -1], "an action of -1 was given"),
        ([0.5, 1], "an action of 0.5 was given"),
        ([np.nan, 1], "an action of nan was given"),
        (1, "actions must be an array .* of 0, 1 and 2, not int64"),
        ("up", "actions must be an array .* of 0, 1 and 2, not <U2"),
    ],
)
def test_an_action_that_is_none_is_named_with_what_would_be_right(action, sentence):
    single, vector = gymnasium.make(NAME).unwrapped, gymnasium.make_vec(NAME, num_envs=1)
    for world, given in ((single, action), (vector, [action])):
        world.reset(seed=1)
        with pytest.raises(ValueError, match=sentence):
            world.step(given)


@pytest.mark.parametrize("kind", [np.uint8, np.int64, np.float32])
def test_actions_are_taken_in_any_kind_of_number(kind):
    world = gymnasium.make(NAME).unwrapped
    world.reset(seed=1)
    world.step(np.array([2, 0], kind))
    assert np.sign(world.world.record().turns).tolist() == [[1.0, -1.0]]


def test_readings_are_those_asked_for():
    world = gymnasium.make(NAME, readings=Readings(object_radius=8.0))
    world.reset(seed=1)
    assert world.unwrapped.world.record().readings.object_radius == 8.0
