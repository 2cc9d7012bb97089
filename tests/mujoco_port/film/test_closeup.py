"""The second camera: there around every contact, and looking at it."""

from itertools import pairwise

import numpy as np
import pytest

from mujoco_port.film.closeup import AFTER_S, BEFORE_S, CloseUp, close_ups, laid_in
from mujoco_port.film.take import kinematic_take


@pytest.fixture(scope="module")
def takes(champion_records, robot):
    return [kinematic_take(record, robot, 1) for record in champion_records]


def test_every_contact_is_seen_from_near_from_before_it_begins_until_after_it_ends(takes):
    assert any(take.touched.any() for take in takes)
    for take in takes:
        episodes = close_ups(take)
        seen = np.zeros(len(take.steps), bool)
        for episode in episodes:
            seen[episode.first : episode.last + 1] = True
        touched = take.touched.any(axis=1)
        for moment in np.flatnonzero(touched):
            before = max(0, moment - round(BEFORE_S / take.moment_s))
            after = min(len(seen) - 1, moment + round(AFTER_S / take.moment_s))
            assert seen[before : after + 1].all()
        assert not seen.any() or touched.any()
        for one, other in pairwise(episodes):
            assert one.last < other.first


def test_what_is_touched_is_within_the_picture(takes):
    for take in takes:
        for episode in close_ups(take):
            for moment in range(episode.first, episode.last + 1):
                places = take.objects[moment][take.touched[moment], :2]
                assert (np.abs(places - episode.centre) < episode.width / 2).all()


def test_the_picture_appears_and_vanishes_by_degrees_but_stays_to_the_end_of_the_film():
    here = {"centre": np.zeros(2), "width": 0.2, "fade": 5.0}
    passing = [CloseUp(10, 30, ends=True, **here).strength(k) for k in range(10, 31)]
    staying = [CloseUp(10, 30, ends=False, **here).strength(k) for k in range(10, 31)]
    np.testing.assert_allclose(passing[:5], [0.2, 0.4, 0.6, 0.8, 1.0])
    np.testing.assert_allclose(passing[-5:], [1.0, 0.8, 0.6, 0.4, 0.2])
    assert staying[-1] == 1.0


def test_an_inset_changes_its_corner_only():
    picture, inset = np.full((400, 500, 3), 200, np.uint8), np.zeros((100, 100, 3), np.uint8)
    laid_in(picture, inset, 0.5)
    assert picture[60, 60, 0] == 100
    assert (picture[200:] == 200).all()
    assert (picture[:, 200:] == 200).all()
