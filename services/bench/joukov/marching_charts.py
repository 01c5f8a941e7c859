"""What the filters make of a march, to look at: figures 8 and 10 of the paper, and the curve over S."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.bench.joukov.marching import (
    CHANGING,
    ESTIMATORS,
    FIRST_SEED,
    GRID,
    LITERAL,
    OURS,
    OWN_PACE,
    TITLES,
    Scores,
    Setting,
    Trial,
    Tuning,
)
from services.bench.joukov.marching_tables import PUBLISHED_ACCELERATION, PUBLISHED_VELOCITY, curve
from services.bench.joukov.recordings import JOINTS
from services.bench.joukov.sections import COLOURS
from services.bench.line_chart import line_chart

FloatArray = NDArray[np.float64]

KNEE = JOINTS.index("knee_flexion_right")
SHOWN_S = (60.0, 62.4)
"""s of the session, long after convergence."""
ACCELERATION = 2
S_LABEL = "process noise S, (rad/s³)²"
TRUTH = "truth"


@dataclass(frozen=True)
class Example:
    """The first scored participant at S*."""

    time_s: FloatArray
    acceleration: dict[str, FloatArray]
    """Right knee, rad/s^2, by estimator, and the truth."""
    beat_time_s: FloatArray
    frequency: dict[str, FloatArray]
    """rad/s, with the changing metronome, and the metronome's."""


def follow_example(tuning: Tuning) -> Example:
    """Run the filters whose tracks are drawn."""
    trial = Trial.of(FIRST_SEED, OWN_PACE)
    runs = {estimator: trial.run(Setting("gravity", estimator, tuning.star)) for estimator in ESTIMATORS}
    time_s = runs[OURS].time_s
    shown = (time_s >= SHOWN_S[0]) & (time_s < SHOWN_S[1])
    acceleration = {TRUTH: trial.truth(time_s[shown])[0][ACCELERATION, :, KNEE]}
    acceleration |= {name: run.state[ACCELERATION, shown, KNEE] for name, run in runs.items()}
    changing = Trial.of(FIRST_SEED, CHANGING)
    beats = {estimator: changing.run(Setting("gravity", estimator, tuning.star)) for estimator in (LITERAL, OURS)}
    every = slice(None, None, 25)
    beat_s = beats[OURS].time_s[every]
    frequency = {"metronome": changing.march.beat.walked(0.0, beat_s).rate * 2 * np.pi}
    frequency |= {name: np.where(run.locked, run.frequency, np.nan)[every] for name, run in beats.items()}
    return Example(time_s[shown], acceleration, beat_s, frequency)


def charts(people: Mapping[str, Scores], example: Example) -> dict[str, str]:
    """SVG by file name."""
    return {
        "marching_acceleration": _acceleration(example),
        "marching_frequency": _frequency(example),
        "marching_curve_acceleration": _curve(people, ACCELERATION, PUBLISHED_ACCELERATION),
        "marching_curve_velocity": _curve(people, 1, PUBLISHED_VELOCITY),
    }


def _acceleration(example: Example) -> str:
    lines = {_title(name): list(zip(example.time_s.tolist(), np.degrees(values).tolist(), strict=True))
             for name, values in example.acceleration.items()}  # fmt: skip
    return line_chart(
        "Right knee of a marching participant, at S* (figure 8)",
        "time, s",
        "acceleration, deg/s²",
        lines,
        from_zero=False,
        colours=COLOURS,
    )


def _frequency(example: Example) -> str:
    lines = {_title(name): list(zip(example.beat_time_s.tolist(), (values / (2 * np.pi)).tolist(), strict=True))
             for name, values in example.frequency.items()}  # fmt: skip
    title, colours = "A metronome that changes every 30 s, at S* (figure 10)", {**COLOURS, "metronome": COLOURS[TRUTH]}
    return line_chart(title, "time, s", "frequency, Hz", lines, from_zero=False, colours=colours)


def _curve(people: Mapping[str, Scores], quantity: int, published: float) -> str:
    name = ("position", "velocity", "acceleration")[quantity]
    lines = {
        _title(estimator): list(zip(GRID.tolist(), curve(people, estimator)[:, quantity].tolist(), strict=True))
        for estimator in (LITERAL, OURS)
    }
    return line_chart(
        f"Marching: {name} error against the plain EKF at the same S",
        S_LABEL,
        "ratio of RMSE",
        lines,
        log_x=True,
        levels={"EKF": 1.0, f"published {100 * (published - 1):+.0f} %": published},
        colours=COLOURS,
    )


def _title(name: str) -> str:
    return TITLES.get(name, name)
