"""How well events are detected: rows of sensitivity, predictive value, time and stride time."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import GaitEventKind, Side
from services.bench.gait.stride_scores import Found, Matched, match, pairs, stride_time_errors_s, together
from services.bench.scoreboard import Row, informative

Array = NDArray[np.float64]
Times = Mapping[tuple[Side, GaitEventKind], Array]
"""Times (n,) s of each kind of event of each foot."""


class Detection(NamedTuple):
    """One walk: the true events of one kind and those that were found."""

    true_s: dict[Side, Array]
    found_s: dict[Side, Array]

    @property
    def matched(self) -> Matched:
        """Pairs of the same foot."""
        return together(match(self.true_s[side], self.found_s[side]) for side in Side)

    @property
    def stride_errors_s(self) -> Array:
        """Errors (n,) s of stride time of both feet."""
        return np.concatenate([stride_time_errors_s(self.true_s[side], self.found_s[side]) for side in Side])

    def rightly_sided(self) -> tuple[int, int]:
        """How many contacts that are found at all have the right foot, and how many there are."""
        true = sorted((float(time), side) for side in Side for time in self.true_s[side])
        found = sorted((float(time), side) for side in Side for time in self.found_s[side])
        paired = pairs(np.array([time for time, _ in true]), np.array([time for time, _ in found]))
        return sum(true[i][1] is found[j][1] for i, j in paired), len(paired)


def detection(true: Times, found: Found, kind: GaitEventKind) -> Detection:
    """The true and the found events of one kind."""
    return Detection(
        {side: true[side, kind] for side in Side}, {side: np.sort(found.times_s(side, kind)) for side in Side}
    )


def detection_rows(name: str, walks: list[Detection], baseline: list[Detection] | None = None) -> list[Row]:
    """All figures of some walks together, beside those of a baseline on the same walks."""
    ours = _figures(walks)
    others = {} if baseline is None else _figures(baseline)
    units = {"bias": "ms", "SD": "ms", "stride time, mean absolute error": "ms"}
    return [
        informative(f"{name}: {title}", value, units.get(title, "1"), others.get(title))
        for title, value in ours.items()
    ]


def _figures(walks: list[Detection]) -> dict[str, float | None]:
    matched = together(walk.matched for walk in walks)
    found = len(matched.errors_s)
    strides = np.concatenate([np.zeros(0), *(walk.stride_errors_s for walk in walks)])
    sided, paired = np.sum([walk.rightly_sided() for walk in walks], axis=0)
    return {
        "sensitivity": _share(found, found + matched.missed),
        "predictive value": _share(found, found + matched.extra),
        "F1": _share(2 * found, 2 * found + matched.missed + matched.extra),
        "right side": _share(int(sided), int(paired)),
        "bias": matched.bias_ms,
        "SD": matched.spread_ms,
        "stride time, mean absolute error": round(float(np.mean(np.abs(strides))) * 1e3, 1) if len(strides) else None,
    }


def _share(part: int, whole: int) -> float | None:
    return round(part / whole, 3) if whole else None
