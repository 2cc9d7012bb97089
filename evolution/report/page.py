"""The page that shows an experiment: one HTML file that needs nothing else, not even a network.

All numbers come from `evolution.results.analysis`; here they become text, tables and pictures, and a template
(template.html) arranges them. The same experiment gives the same page.
"""

from __future__ import annotations

import shlex
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from arm2d.network.genes import counted
from evolution.agents.classes import Sampling
from evolution.agents.postevaluation import TRIALS
from evolution.agents.subtasks import SUBTASKS, AgentClass
from evolution.experiments.stage_times import stage_times
from evolution.experiments.standing import standing_of
from evolution.figures.paper import all_figures
from evolution.player.agents import described, is_playable
from evolution.player.page import as_json, player_parts
from evolution.report.classes import behaviours_kept, class_figures
from evolution.report.configuration import readings_rows, settings_rows, versions_rows
from evolution.report.films import films_of
from evolution.report.pictures import figure_uri, file_uri
from evolution.report.safety import content_policy
from evolution.report.sentences import departures_in_size, result_sentences, standing_of_best
from evolution.report.tables import category_tables, main_lines, shown_runs, shown_tests
from evolution.results.notable import NotableAgent, best_agent
from evolution.results.records import ConditionResults, Results
from evolution.results.wording import TITLES, generalisers_sentence
from evolution.runs.sources import find_agent
from evolution.runs.storage import make_folder, write_atomically

TEMPLATE: Final = "template.html"
# Where `wordarm lineage` and `wordarm behaviour` put what they draw, and what it shows.
FIGURE_FOLDERS: Final = {"lineage": "Its line of ancestors", "behaviour": "How it does it"}


def write_report(results: Results, path: Path | str) -> Path:
    """Write the page.

    Args:
        results: The analysed experiment.
        path: The file.

    Returns:
        The same path.

    Raises:
        ValueError: If a file of a shown run is damaged.
        OSError: If it cannot be written.
    """
    path = Path(path)
    make_folder(path.parent)
    # Names of folders and files may be no text at all.
    write_atomically(path, render(results, path.parent).encode(errors="replace"))
    return path


def render(results: Results, home: Path) -> str:
    """The page's text; links to films are relative to the folder `home`."""
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    template, player = environment.get_template(TEMPLATE), player_parts()
    policy = content_policy(Path(str(template.filename)).read_text(encoding="utf-8"), player["script"])
    return template.render(policy=policy, player=player, **_content(results, home))


def _content(results: Results, home: Path) -> dict[str, Any]:
    """Everything the template shows."""
    shown = replace(results, conditions={c: e for c, e in results.conditions.items() if len(e.runs)})
    best = [(found, best_agent(found)) for found in shown.conditions.values()]
    agents = [_agent(found, agent, results.experiment.path) for found, agent in best if agent is not None]
    players = [agent["player"] for agent in agents if agent["player"] is not None]
    figures = all_figures(shown) if shown.conditions else {}
    experiment = results.experiment
    return {
        "name": experiment.path.resolve().name,
        "sentences": result_sentences(results),
        "missing": results.missing,
        "sizes": departures_in_size(results),
        "titles": [TITLES[condition] for condition in shown.conditions],
        "main_lines": main_lines(shown),
        "category_tables": category_tables(shown),
        "generalisers": [generalisers_sentence(found) for found in shown.conditions.values()],
        "runs": shown_runs(shown),
        "tests": shown_tests(results),
        "standings": [standing_of(run.path, run.config) for run in experiment.all_runs],
        "subtasks": SUBTASKS,
        "classes": [str(kind) for kind in AgentClass],
        "figures": {name: figure_uri(figure) for name, figure in figures.items()},
        "agents": agents,
        **_classes(shown),
        "players": as_json(players) if players else "",
        "neurons": counted(experiment.all_runs[0].config.settings.inter_neurons),
        "trials": TRIALS,
        "films": list(films_of(experiment.path, home)),
        "settings": settings_rows(results),
        "readings": readings_rows(experiment.readings),
        "versions": versions_rows(results),
        "times": stage_times(experiment.path),
    }


def _agent(found: ConditionResults, agent: NotableAgent, experiment: Path) -> dict[str, Any]:
    """The best agent of a condition: as it lives in the page, and figures that lie beside its run."""
    figures, refused = _figures_beside(agent)
    return {
        "condition": TITLES[found.condition],
        "what": standing_of_best(found),
        "seed": agent.run.config.seed,
        "generation": agent.generation,
        "rank": agent.rank,
        "source": shlex.quote(str(agent.run.path.relative_to(experiment))),
        "player": _player(found, agent),
        "figures": figures,
        "refused": refused,
    }


def _player(found: ConditionResults, agent: NotableAgent) -> dict[str, Any] | None:
    """What the page's player is told of the agent; None if it cannot run its network.

    Raises:
        ValueError: If the agent's run is damaged.
    """
    source = find_agent(str(agent.run.path), generation=agent.generation, rank=agent.rank)
    if not is_playable(source.genotype):
        return None
    origin = f"seed {agent.run.config.seed}, generation {agent.generation}, rank {agent.rank}"
    note = f"The {standing_of_best(found)}: {origin}."
    return described(source, TITLES[found.condition], note, agent.successes.tolist())


def _classes(shown: Results) -> dict[str, Any]:
    """What was observed of the classes of agents, and how to observe what was not."""
    behaviours, missing = behaviours_kept(shown, Sampling())
    figures = class_figures(behaviours, Sampling())
    some = any(found.members[kind].any() for found in shown.conditions.values() for kind in AgentClass)
    return {
        "class_figures": [figure_uri(figure) for figure in figures.values()],
        "class_missing": missing,
        "has_classes": some,
    }


def _figures_beside(agent: NotableAgent) -> tuple[list[tuple[str, str]], list[str]]:
    """(caption, picture) of what was drawn for exactly this agent; a sentence for each that is not shown."""
    stem = f"generation-{agent.generation:06d}-rank-{agent.rank}"
    figures, refused = [], []
    for folder, caption in FIGURE_FOLDERS.items():
        for path in sorted((agent.run.path / folder).glob(f"{stem}*.svg")):
            what = path.stem.removeprefix(stem).strip("-").replace("-", " ")
            try:
                figures.append((f"{caption}: {what}" if what else caption, file_uri(path)))
            except (ValueError, OSError) as error:
                refused.append(f"{path} is not shown: {error}")
    return figures, refused
