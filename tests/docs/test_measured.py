"""Tables of the docs against the rows that they were counted from."""

import csv
from collections import defaultdict
from pathlib import Path

import numpy as np

from arm2d import Condition, Instruction, draw_trials, record_trial
from arm2d.constants import ALPHA_MAX, ALPHA_MIN
from evolution.runs.sources import find_agent
from evolution.search.randomness import Purpose, generator

DOCS = Path(__file__).parents[2] / "docs"
AGENTS = ("best-generaliser", "best-specialist", "with-ignore")
LOOPS = ("open", "delayed", "geometric", "camera")
PHYSICS = (DOCS / "physics.md").read_text(encoding="utf-8")


def rows(name):
    lines = (DOCS / "results" / name).read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def by(found, *names):
    groups = defaultdict(list)
    for row in found:
        groups[tuple(row[name] for name in names)].append(row)
    return groups


def both(found):
    """(trials that arm and robot carry out, trials that the arm does)."""
    planar = [row for row in found if row["planar"] == "1"]
    return sum(row["physical"] == "1" for row in planar), len(planar)


def test_agreement_is_what_its_trials_say():
    found = rows("agreement.csv")
    for (instruction,), own in by(found, "instruction").items():
        groups = by(own, "agent")
        cells = ["{} of {}".format(*both(groups[name,])) if (name,) in groups else "-" for name in AGENTS]
        assert f"| {instruction} | {' | '.join(cells)} |" in PHYSICS
    for own in by(found, "agent").values():
        carried_out, of = both(own)
        assert f"**{carried_out} of {of}, {100 * carried_out / of:.1f} %**" in PHYSICS
    carried_out, of = both(found)
    told = f"of {of} trials that the planar arm carries out"
    readme = (DOCS.parent / "README.md").read_text("utf-8")
    assert f"{told}, an iCub with motors, contacts and free objects carries out {carried_out} " in readme
    article = (DOCS / "article.md").read_text("utf-8")
    assert f"| {carried_out} of {of} |" in article
    assert f"{told} the robot carries out {carried_out}" in article
    before, of_before = both(rows("agreement-plain.csv"))
    assert f"plain readings: {before} of {of_before} trials" in article
    assert f"{before} of {of_before}, {100 * before / of_before:.1f} %" in PHYSICS


def test_closed_loops_are_what_their_trials_say():
    found = rows("closed-loop.csv")
    for (agent, instruction), own in by(found, "agent", "instruction").items():
        assert f"| `{agent}`, {instruction} | {' | '.join(map(str, counts_of(own)))} |" in PHYSICS
    for (agent,), own in by(found, "agent").items():
        assert f"| **`{agent}`** | {' | '.join(f'**{n}**' for n in counts_of(own))} |" in PHYSICS
    trials, planar, *_, camera = counts_of(found)
    told = f"{camera} of {trials} trials"
    assert f"{told} are carried out with the camera, where the planar arm carries out {planar}" in PHYSICS
    article = " ".join((DOCS / "article.md").read_text(encoding="utf-8").split())
    assert f"carry out {told}, where the planar arm carries out {planar}" in article
    trials, planar, *_, camera = counts_of(rows("closed-loop-plain.csv"))
    assert f"{camera} of {trials}, where the planar arm carried out {planar}" in PHYSICS


def counts_of(found):
    """Trials, those that the planar arm carries out, and those that the robot does, loop by loop."""
    loops = by(found, "loop")
    planar = sum(row["planar"] == "1" for row in loops["open",])
    counts = [sum(row["physical"] == "1" for row in loops[name,]) for name in LOOPS]
    return [len(loops["open",]), planar, *counts]


def test_lines_of_descent_are_what_their_skills_say():
    page, article = ((DOCS / name).read_text(encoding="utf-8") for name in ("results.md", "article.md"))
    never, experienced = 10**9, [str(each) for each in Condition.WITH_INDICATE.experienced]
    before_seven = before_green = red_first = 0
    lines = by(rows("lineages.csv"), "seed", "generation", "rank")
    assert len(lines) == 10
    for (seed, generation, rank), own in lines.items():
        came = {
            row["skill"]: never if row["first came"] == "never" else int(row["first came"]) for row in own
        }
        told = {row["skill"]: row["first came"] for row in own}
        first = [skill for skill, when in came.items() if when == min(came.values())]
        assert not any("S2 bent" in skill for skill in first)
        bent = [f"on target, S2 bent, hearing {word}" for word in ("MOVE", "TOUCH", "INDICATE")]
        seven = max(came[each] for each in experienced)
        cells = [
            seed, f"{generation}, {rank}", f"{' and '.join(first)}, {min(came.values())}",
            ", ".join(told[each] for each in bent), str(seven), f"{told['MOVE Blue']}, {told['TOUCH Green']}",
        ]  # fmt: skip
        assert f"| {' | '.join(cells)} |" in page
        assert came["MOVE Blue"] < came["TOUCH Green"]
        pointing = max(came[each] for each in bent)
        before_seven += pointing < seven
        before_green += pointing < came["TOUCH Green"]
        red_first += "MOVE Red" in first
    assert (red_first, before_seven, before_green) == (7, 7, 8)
    assert "in seven lines S1 finds" in page
    assert "and in eight before TOUCH Green" in page
    assert "before TOUCH Green is understood in 8 |" in article


def test_head_held_and_turning_are_what_their_trials_say():
    found = rows("head-plain.csv")
    sums = [sum(int(row[name]) for row in found) for name in ("planar", "held", "turns")]
    differ = sum(row["held"] != row["turns"] for row in found)
    cells = " | ".join(f"**{n:,}**" for n in (len(found), *sums, differ))
    assert f"| **all** | {cells} |" in PHYSICS


def test_a_card_s_figures_are_those_of_its_benchmark():
    page = " ".join((DOCS / "speed.md").read_text(encoding="utf-8").split())
    found = {row["what"]: row["found"] for row in rows("device/device.csv")}
    assert f"{found['100 runs, 8 processes, 6000 generations'].split(',')[0]} |" in page
    assert f"{found['1000 runs, 16 processes, 3000 generations'].split(',')[0]} |" in page
    assert f"{found['device, 1 processes'].split(';')[0]}, extrapolated" in page
    alike = [row["found"].split() for row in rows("device/device.csv") if row["stage"] == "same bits"]
    assert f"{sum(int(n) for n, *_ in alike)} of {sum(int(n) for _, _, n, _ in alike)} trials" in page


def directions(name, words):
    """S1's angles in each of an agent's successful trials, of the 80 that `wordarm evaluate` draws."""
    agent = find_agent(name)
    asked = Instruction.parse(words)
    rng = generator(0, Purpose.EVALUATION)
    trials = draw_trials(agent.condition.instructions, 40, agent.readings, rng, agent.condition)
    own = np.flatnonzero((trials.actions == asked.action) & (trials.objects == asked.object))
    found = [record_trial(agent.genotype, trials[t], agent.readings) for t in own]
    return [record.alpha for record in found if record.success]


def test_agents_use_the_stops_as_the_page_says():
    page = " ".join((DOCS / "results.md").read_text(encoding="utf-8").split())
    stops = {ALPHA_MIN, ALPHA_MAX}
    for name, resting in (
        ("best-generaliser", {}),
        ("best-specialist", {"touch blue": ALPHA_MIN, "indicate blue": ALPHA_MIN}),
        ("with-ignore", {"ignore blue": ALPHA_MAX, "ignore green": ALPHA_MAX, "ignore red": ALPHA_MAX}),
    ):
        for instruction in find_agent(name).condition.instructions:
            words = str(instruction).lower()
            found = directions(name, words)
            assert len(found) in (0, 80)
            if words in resting:
                assert {alpha[-1] for alpha in found} == {resting[words]}
            else:
                assert not any(stops & set(alpha) for alpha in found)
    assert "`best-generaliser` never rests at a stop" in page
    assert "`best-specialist` carries out TOUCH Blue and INDICATE Blue only with S1 at its right stop" in page
    assert "`with-ignore` turns to its left stop for every IGNORE" in page


def test_algorithms_are_told_as_their_table_has_them():
    page = (DOCS / "how-to" / "algorithm.md").read_text(encoding="utf-8")
    own = {row["algorithm"]: row for row in rows("algorithms.csv")}
    told = {
        cells[0].strip(): [cell.strip() for cell in cells[1:3]]
        for line in page.splitlines()
        if len(cells := line.strip("|").split("|")) == 3
    }
    ordered = [own["genetic"], own["cma-es"]]
    reach = told["runs that reach 18/7, all that can be had"]
    assert reach == [f"{row['reach 18/7']} of {row['runs']}" for row in ordered]
    for name, column in (
        ("95 % interval of their share", "95 % interval"),
        ("runs that end there", "end at 18/7"),
        ("CPU until then, median [s]", "CPU to get there (median) [s]"),
        ("CPU of a whole run, mean [s]", "CPU of a run (mean) [s]"),
        ("runs with a late agent that understands MOVE Blue", "understand MOVE Blue"),
        ("runs with one that understands TOUCH Green", "understand TOUCH Green"),
        ("runs with one that understands both", "understand both"),
    ):
        assert told[name] == [row[column] for row in ordered], name
    scored = [f"{float(row['evaluations to get there (median)']):,.0f}" for row in ordered]
    assert told["genotypes scored until then, median"] == scored
