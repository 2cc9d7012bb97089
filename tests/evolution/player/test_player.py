"""The page in Node: what a reader's hand does to a trial, counts beside the kernel's, and how it is built."""

import json
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

from arm2d import Condition, Trials, run_trials
from evolution.player.__main__ import SHIPPED, main
from evolution.player.agents import agent_for_page
from evolution.player.bundle import bundle
from evolution.player.page import as_json, render_page
from evolution.runs.sources import find_agent
from tests.evolution.player.node import NODE

ROOT = Path(__file__).parents[3]
PAGE = ROOT / "docs" / "play" / "index.html"


@pytest.fixture(scope="module")
def sources():
    return [find_agent(each) for each in SHIPPED]


@pytest.fixture(scope="module")
def found(sources, tmp_path_factory):
    """What session.js reports."""
    folder = tmp_path_factory.mktemp("session")
    script, agents = folder / "session.js", folder / "agents.json"
    script.write_text(bundle("main") + Path(__file__).with_name("session.js").read_text(encoding="utf-8"))
    agents.write_text(json.dumps([agent_for_page(each) for each in sources]))
    done = subprocess.run([NODE, script, agents], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def test_word_changed_in_mid_trial_leaves_what_was_and_is_judged_anew(found):
    assert found["calm"].startswith("Done: TOUCH Red carried out in ")
    assert found["sameBefore"]
    assert found["changed"].startswith("Done: MOVE Red carried out in ")


def test_after_a_change_the_new_words_are_heard_from_the_start_of_the_next_trial(found):
    assert found["again"]


def test_moving_an_object_drops_the_states_ahead(found):
    assert found["dropped"] == 6
    assert found["blueAt"] == pytest.approx(np.degrees(np.arctan2(-60, 120)))


def test_what_is_done_grows_where_nothing_ends_a_trial_and_stays_where_runs_are_counted_all_in_all(found):
    assert found["unended"] == 0.5  # 50 of the 100 steps away that are asked for
    assert found["paused"] == 0.25


def test_why_an_action_that_was_done_is_no_success_is_said(found):
    reasons = [text.removeprefix("Not done: ").split(" (")[0] for text in found["ended"]]
    assert reasons == [
        "it stayed away, but had Blue in view in the end",
        "it did the action, but ended off the object",
        "it did the action, but with a bent forearm",
        "time is up",
    ]


def test_silenced_word_is_three_zeros_and_silenced_neuron_says_nothing(found):
    assert found["deaf"] == [0, 0, 0, 1, 0, 1]
    assert set(found["mute"]) == {0}


def test_third_action_of_another_condition_takes_its_place(found):
    assert found["third"] == {"action": 3, "object": 0}


def test_page_counts_what_the_kernel_counts_from_the_same_starts(found, sources):
    alpha = np.array([each["alpha"] for each in found["starts"]])
    discs = np.array([each["centres"] for each in found["starts"]])
    for source, counts in zip(sources, found["counts"], strict=True):
        instructions = source.condition.instructions
        actions, objects = (
            np.repeat([getattr(each, kind) for each in instructions], 80) for kind in ("action", "object")
        )
        scores = run_trials(source.genotype, Trials(actions, objects, alpha, discs), source.readings)
        assert scores.success.reshape(9, 80).sum(axis=1).tolist() == counts


def test_page_counts_agree_with_ours_within_sampling(found, sources):
    for source, counts in zip(sources, found["counts"], strict=True):
        ours = np.array(agent_for_page(source)["successes"])
        share = (ours + np.array(counts) + 1) / 162
        spread = np.sqrt(2 * 80 * share * (1 - share))
        assert (
            np.abs(ours - counts) < 4 * spread + 1
        ).all()  # 27 differences, each with four standard errors


def test_starts_are_uniform_in_their_areas_and_on_their_chords(found, sources):
    (low, high), _ = sources[0].readings.start_intervals
    alpha = np.array([each["alpha"] for each in found["starts"]])
    right = alpha[np.arange(720) % 80 < 40]
    near = (high - low) / 40
    assert low <= right.min() < low + near
    assert high - near < right.max() <= high
    error = (high - low) / np.sqrt(12 * 360)  # of the mean of 360 draws
    assert right.mean() == pytest.approx((low + high) / 2, abs=4 * error)
    blue = np.array([each["centres"][0] for each in found["starts"]])
    bearings = np.degrees(np.arctan2(blue[:, 1], blue[:, 0]))
    assert 20.0 <= bearings.min() < 20.3
    assert 39.7 < bearings.max() <= 40.0


def test_page_of_the_repository_is_what_its_sources_give(sources):
    assert PAGE.read_text(encoding="utf-8") == render_page(sources)


def test_page_is_small_whole_and_free_of_jargon(sources):
    text = PAGE.read_text(encoding="utf-8")
    assert PAGE.stat().st_size < 400_000
    visible = text[text.index("<body>") : text.index("const wordarm")].lower()
    for jargon in ("18/7", "kernel", "genotype", "ctrnn", "bearing"):
        assert jargon not in re.sub(r"<script.*?</script>", "", visible, flags=re.DOTALL)
    for reference in ("src=", "@import", "url(http", "fetch(", "XMLHttpRequest", "WebSocket"):
        assert reference not in text


def test_command_writes_the_page_of_any_agent(tmp_path, capsys):
    assert main(["best-specialist", "--output", str(tmp_path / "a" / "page.html")]) == 0
    assert capsys.readouterr().out == f"{tmp_path / 'a' / 'page.html'}\n"
    text = (tmp_path / "a" / "page.html").read_text(encoding="utf-8")
    assert "The specialist" in text
    assert "The generaliser" not in text


def test_command_refuses_an_agent_that_does_not_exist(capsys):
    assert main(["nobody"]) == 2
    assert "there is no 'nobody'" in capsys.readouterr().err


def test_genes_in_the_page_are_the_agents_own_bits(sources):
    for source in sources:
        read = json.loads(as_json(agent_for_page(source)))
        assert np.array_equal(read["genotype"], source.genotype)
        assert Condition(read["condition"]) is source.condition


def test_strings_cannot_close_the_script_they_stand_in():
    assert as_json({"name": "</script>"}) == '{"name":"\\u003c/script>"}'


def test_modules_in_a_circle_are_refused(tmp_path):
    (tmp_path / "a.js").write_text('import { b } from "./b.js";\nexport const a = 1;\n')
    (tmp_path / "b.js").write_text('import { a } from "./a.js";\nexport const b = 1;\n')
    with pytest.raises(ValueError, match="modules import one another in a circle: a > b > a"):
        bundle("a", tmp_path)


def test_imports_of_another_form_are_refused(tmp_path):
    (tmp_path / "a.js").write_text('import * as b from "./b.js";\n')
    with pytest.raises(
        ValueError,
        match=r"""a\.js: write import \{ a \} from "\./module\.js" or export const a, not \'import \*""",
    ):
        bundle("a", tmp_path)


def test_names_private_to_a_module_do_not_meet(tmp_path):
    (tmp_path / "a.js").write_text(
        'import { two } from "./b.js";\nconst own = 1;\nexport const sum = own + two;\n'
    )
    (tmp_path / "b.js").write_text("const own = 2;\nexport const two = own;\n")
    script = bundle("a", tmp_path) + "console.log(wordarm.sum);\n"
    done = subprocess.run([NODE, "-e", script], check=True, capture_output=True, text=True)
    assert done.stdout == "3\n"


# Machado, Oliveira and Fernandes (2009), severity 1, in linear RGB.
COLOUR_BLINDNESS = {
    "none": np.eye(3),
    "protanopia": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "deuteranopia": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
    "tritanopia": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]
    ),
}
RGB_TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def lab(colour, blindness):
    """A colour such as #1d56a8 in CIELAB, as seen with a kind of colour blindness."""
    channels = np.array([int(colour[at : at + 2], 16) for at in (1, 3, 5)]) / 255
    linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
    seen = np.clip(COLOUR_BLINDNESS[blindness] @ linear, 0, 1)
    x, y, z = np.cbrt(RGB_TO_XYZ @ seen / (0.9505, 1.0, 1.089))
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


@pytest.mark.parametrize("blindness", COLOUR_BLINDNESS)
def test_objects_are_told_apart_with_any_colour_blindness(blindness):
    style = (ROOT / "evolution" / "player" / "player.css").read_text(encoding="utf-8")
    themes = zip(
        *(re.findall(rf"--wa-{name}: (#\w+);", style) for name in ("blue", "green", "red")), strict=True
    )
    for theme, colours in zip(("light", "dark"), themes, strict=True):
        blue, green, red = (lab(each, blindness) for each in colours)
        for one, other in ((blue, green), (green, red), (blue, red)):
            # A difference of 2.3 can just be seen side by side.
            assert np.linalg.norm(one - other) > 25, theme
