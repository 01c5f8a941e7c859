"""A simulated person of the scoreboard through the node: the figures are the scoreboard's."""

import numpy as np
import pytest

from services.bench.kinect import methods
from services.bench.kinect.cells import score
from services.bench.kinect.trials import watch
from tests.unit.estimation.body import body_sessions as sessions

PERSON, TASK = 3, 2
"""One of the scored people, stepping: that needs no recording."""


@pytest.fixture(scope="module")
def person():
    """As seen, and what the node makes of it: times, angles, deviations and validity."""
    watched = watch(PERSON, TASK, "clinic")
    body = [1 if state.any() else None for state in watched.seen.state]
    stream = sessions.messages(np.nan_to_num(watched.seen.centres), watched.seen.state, body=body)
    outputs = sessions.run(sessions.node(sessions.describe(height_m=watched.who.stature)), stream)
    times, position, valid = sessions.table(outputs)
    deviation = sessions.table(outputs, "position_std")[1]
    frames = np.round(times * sessions.RATE_HZ / 1e9).astype(int) - 1
    return watched, frames, position[:, :22], deviation[:, :22], valid[:, :22]


def test_through_the_node_a_person_is_as_accurate_as_on_the_scoreboard(person):
    watched, frames, position, _, _ = person
    angles = np.repeat(position[:1], len(watched.angles), axis=0)
    angles[frames] = position
    through_node, alone = (score(TASK, found, watched.angles) for found in (angles, methods.ours(watched)))
    rmsd, alone_rmsd = (float(np.mean([cell.rmsd_deg for cell in cells])) for cells in (through_node, alone))
    assert rmsd == pytest.approx(alone_rmsd, abs=0.1)


def test_deviations_are_as_large_as_errors(person):
    watched, frames, position, deviation, valid = person
    error, late = np.abs(position - watched.angles[frames]), frames > 60
    shown = valid & late[:, None]
    assert 0.92 < (error < 2.0 * deviation)[shown].mean() < 0.995


def test_what_can_be_seen_is_shown_nearly_always(person):
    _, _, _, _, valid = person
    names = ("pelvis_tilt", "hip_flexion_right", "hip_flexion_left", "knee_flexion_right", "knee_flexion_left")
    assert valid[:, [sessions.NAMES.index(name) for name in names]].mean(axis=0).min() > 0.75
