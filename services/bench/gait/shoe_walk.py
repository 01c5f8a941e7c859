"""Strides by sensors on the shoes against strides labelled by hand (gaitmap's example walk).

The labels begin where the foot turns back fastest in stance, not at contact, so they judge counts and durations.
Nothing was chosen on this person.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import GaitEventKind, Side
from services.bench.gait.strides import ESTIMATOR, through_chain
from services.bench.scoreboard import Row, informative
from services.ingest.data import find_data
from services.ingest.errors import SourceError

Array = NDArray[np.float64]

SPEC, DATA = "gaitmap_feet", "gaitmap_foot_imu"
RATE_HZ = 204.8


class Labelled(NamedTuple):
    """Strides of one foot: start and end (n,) s."""

    start_s: Array
    end_s: Array


def shoe_rows() -> list[Row]:
    """Share of the labelled strides with exactly one contact, contacts in none of them, and the stride time."""
    try:
        labels = labelled_strides()
        found = through_chain(SPEC, ESTIMATOR).found
    except SourceError as missing:
        return [Row("gaitmap: skipped", None, "", str(missing), None, None)]
    one, total, outside = 0, 0, 0
    errors: list[float] = []
    for side in Side:
        contacts = np.sort(found.times_s(side, GaitEventKind.INITIAL_CONTACT))
        counts = _contacts_within(labels[side], contacts)
        one, total = one + int(np.sum(counts == 1)), total + len(counts)
        outside += len(contacts) - int(np.sum(counts))
        errors += stride_errors_s(labels[side], contacts)
    rows = [
        informative(f"gaitmap, feet: sensitivity of {total} labelled strides", round(one / total, 3), "1"),
        informative("gaitmap, feet: contacts outside of them, first and last steps included", outside, ""),
    ]
    if not errors:
        return rows
    mean_ms, spread_ms = (round(float(figure) * 1e3, 1) for figure in (np.mean(errors), np.std(errors)))
    return [
        *rows,
        informative(f"gaitmap, feet: stride time, mean error of {len(errors)}", mean_ms, "ms"),
        informative("gaitmap, feet: stride time, SD", spread_ms, "ms"),
    ]


def labelled_strides() -> dict[Side, Labelled]:
    """The labels of both feet. Raises a SourceError without the data."""
    path = find_data(DATA) / "stride_borders_sample.csv"
    rows = [line.split(",") for line in path.read_text(encoding="utf-8").splitlines()[1:]]
    found = {}
    for side in Side:
        times = np.array([(float(row[2]), float(row[3])) for row in rows if row[1] == side.value]) / RATE_HZ
        found[side] = Labelled(times[:, 0], times[:, 1])
    return found


def stride_errors_s(labels: Labelled, contacts_s: Array) -> list[float]:
    """From contact to contact against the label that begins within: neighbouring labels with one contact each."""
    errors = []
    for i in range(len(labels.start_s) - 1):
        ends = [contacts_s[(contacts_s >= labels.start_s[k]) & (contacts_s < labels.end_s[k])] for k in (i, i + 1)]
        if labels.end_s[i] == labels.start_s[i + 1] and len(ends[0]) == 1 and len(ends[1]) == 1:
            # The contact lies in the label's second half, so both labels share the time between the contacts.
            mean_s = 0.5 * (labels.end_s[i + 1] - labels.start_s[i])
            errors.append(float(ends[1][0] - ends[0][0]) - float(mean_s))
    return errors


def _contacts_within(labels: Labelled, contacts_s: Array) -> NDArray[np.int64]:
    return np.array(
        [np.sum((contacts_s >= a) & (contacts_s < b)) for a, b in zip(labels.start_s, labels.end_s, strict=True)],
        dtype=np.int64,
    )
