"""Contacts by the lower back alone against pressure insoles and motion capture (mobgap's example person HA_001).

Two straight walks and two minutes of daily activities. Nothing was chosen on this person, except that the smoothed
upward acceleration beat the forward one in a first look at all recordings.
"""

from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import GaitEventKind, Side
from services.bench.gait.detections import Detection, detection_rows
from services.bench.gait.mobgap_baseline import library_contacts_s
from services.bench.gait.strides import ESTIMATOR, through_chain
from services.bench.scoreboard import Row, informative
from services.ingest.data import find_data
from services.ingest.errors import SourceError

Array = NDArray[np.float64]

DATA = "mobgap_lower_back/HA_001"
RATE_HZ = 100.0
PARTS = {"straight walks": "Test5", "daily activities": "Test11"}
REFERENCES = ("INDIP", "Stereophoto")
MARGIN_S = 0.5
"""s around a bout of the reference within which a contact is judged against it."""
IC = GaitEventKind.INITIAL_CONTACT
# x points up the spine, y to the right, z into the body.
MANIFEST = """
title = "Lower back (mobgap HA_001)"
data = "."
rate_hz = 100.0
[anthropometry]
thigh_length_m = 0.42
shank_length_m = 0.42
hip_width_m = 0.18
source = "default"
[imu]
file = "back.csv"
specific_force = { columns = "acc_{axis}", unit = "g" }
angular_velocity = { columns = "gyr_{axis}", unit = "deg/s" }
[[hub]]
name = "back"
[[hub.sensor]]
name = "lower_back"
segment = "pelvis"
outward_axis = [0.0, 0.0, -1.0]
placement = "posterior"
"""


class Bout(NamedTuple):
    """One bout of walking of a reference system."""

    start_s: float
    end_s: float
    contacts_s: dict[Side, Array]


class BackWalk(NamedTuple):
    """One recording: the samples and the bouts by reference."""

    samples: Array  # (n, 6) g and deg/s, sensor axes
    bouts: dict[str, list[Bout]]


def lower_back_rows() -> list[Row]:
    """Detection within the bouts of each reference, false contacts outside; one row that says why without the data."""
    rows: list[Row] = []
    try:
        for part, test in PARTS.items():
            walks = [(walk, found_contacts_s(walk)) for walk in recorded_walks(test)]
            for reference in REFERENCES:
                ours = [within(walk.bouts[reference], contacts) for walk, contacts in walks]
                library = [_by_library(walk, reference) for walk, _ in walks]
                others = [
                    within(walk.bouts[reference], contacts)
                    for (walk, _), contacts in zip(walks, library, strict=True)
                    if contacts is not None
                ]
                rows += detection_rows(f"mobgap {part} by {reference}", ours, others or None)
            rows.append(_outside_row(part, walks))
    except SourceError as missing:
        return [Row("mobgap: skipped", None, "", str(missing), None, None)]
    return rows


def recorded_walks(test: str) -> Iterator[BackWalk]:
    """The recordings of one test. Raises a SourceError without the data."""
    from scipy.io import loadmat

    path = find_data(DATA) / "data.mat"
    trials = getattr(loadmat(path, squeeze_me=True, struct_as_record=False)["data"].TimeMeasure1, test)
    for name in trials._fieldnames:
        trial = getattr(trials, name)
        samples = np.hstack([trial.SU.LowerBack.Acc, trial.SU.LowerBack.Gyr])
        bouts = {reference: _bouts(getattr(trial.Standards, reference)) for reference in REFERENCES}
        yield BackWalk(samples, bouts)


def _bouts(reference: Any) -> list[Bout]:
    return [
        Bout(float(bout.Start), float(bout.End), {side: _contacts_s(bout, side) for side in Side})
        for bout in np.atleast_1d(reference.MicroWB)
    ]


def _contacts_s(bout: Any, side: Side) -> Array:
    times, sides = np.atleast_1d(bout.InitialContact_Event), np.atleast_1d(bout.InitialContact_LeftRight)
    return np.array([float(t) for t, s in zip(times, sides, strict=True) if s == side.value.capitalize()])


def found_contacts_s(walk: BackWalk) -> dict[Side, Array]:
    """Contacts (n,) s of each foot, by the whole chain."""
    with TemporaryDirectory() as folder:
        (Path(folder) / "recording.toml").write_text(MANIFEST, encoding="utf-8")
        header = ",".join(f"{kind}_{axis}" for kind in ("acc", "gyr") for axis in "xyz")
        np.savetxt(Path(folder) / "back.csv", walk.samples, "%.6f", ",", header=header, comments="")
        found = through_chain(folder, ESTIMATOR).found
    return {side: np.sort(found.times_s(side, IC)) for side in Side}


def _by_library(walk: BackWalk, reference: str) -> dict[Side, Array] | None:
    bouts_s = [(bout.start_s - MARGIN_S, bout.end_s + MARGIN_S) for bout in walk.bouts[reference]]
    return library_contacts_s(walk.samples, bouts_s, RATE_HZ)


def within(bouts: list[Bout], found_s: dict[Side, Array]) -> Detection:
    """The true contacts of all bouts beside the found ones in and around them."""
    true = {side: np.sort(np.concatenate([bout.contacts_s[side] for bout in bouts])) for side in Side}
    return Detection(true, {side: times[_is_within(bouts, times)] for side, times in found_s.items()})


def _is_within(bouts: list[Bout], times_s: Array) -> NDArray[np.bool_]:
    inside = np.zeros(len(times_s), dtype=np.bool_)
    for bout in bouts:
        inside |= (times_s >= bout.start_s - MARGIN_S) & (times_s <= bout.end_s + MARGIN_S)
    return inside


def _outside_row(part: str, walks: list[tuple[BackWalk, dict[Side, Array]]]) -> Row:
    """Contacts per minute that lie in no bout of either reference. Some are steps: neither sees all of the room."""
    outside, minutes = 0, 0.0
    for walk, contacts in walks:
        bouts = [bout for reference in REFERENCES for bout in walk.bouts[reference]]
        times_s = np.arange(len(walk.samples)) / RATE_HZ
        minutes += float(np.sum(~_is_within(bouts, times_s))) / RATE_HZ / 60.0
        outside += sum(int(np.sum(~_is_within(bouts, times))) for times in contacts.values())
    return informative(
        f"mobgap {part}: contacts outside all bouts, per minute of {minutes:.1f}", outside / minutes, "1/min"
    )
