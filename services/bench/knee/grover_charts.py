"""Figures 5 and 6 of the published band."""

import numpy as np
from numpy.typing import NDArray

from services.bench.knee.grover_scores import LITERAL, PAPER_BIAS, WINDOWS, Traces, bias_curves
from services.bench.line_chart import line_chart

Array = NDArray[np.float64]

COLOURS = {"truth": "#222222", "conventional": "#d98c1f", "simplified": "#8e5ea2", "ours": "#1f6fb2"}
SHOWN_S = (60.0, 66.0)
FIRST_SHOWN = 100
"""Samples; shorter windows hold less than a stride or two."""
BIAS_SHARE = 0.05


def figure_5() -> str:
    """The thigh's bias by the length of the window."""
    true = abs(float(np.degrees(PAPER_BIAS[0, 2])))
    kept = {
        name: [(w, b) for w, b in zip(WINDOWS.tolist(), np.degrees(curve).tolist(), strict=True) if w >= FIRST_SHOWN]
        for name, curve in bias_curves().items()
    }
    levels = {"true bias": true, "5 % more": true * (1.0 + BIAS_SHARE), "5 % less": true * (1.0 - BIAS_SHARE)}
    title = "Thigh's bias by window length (figure 5)"
    return line_chart(title, "window, samples of 50 ms", "bias, deg/s", kept, from_zero=False, levels=levels)


def figure_6(name: str, found: Traces) -> str:
    """Some seconds of an activity after the simplified filter has begun."""
    time_s = np.arange(1, len(found.truth) + 1) / LITERAL.rate_hz
    shown = (time_s >= SHOWN_S[0]) & (time_s < SHOWN_S[1])
    angles = {name: getattr(found, name)[shown] for name in COLOURS}
    lines = {name: _points(time_s[shown], angle) for name, angle in angles.items()}
    return line_chart(
        f"Knee while {name} (figure 6)", "time, s", "flexion, deg", lines, from_zero=False, colours=COLOURS
    )  # fmt: skip


def first_minute(name: str, found: Traces) -> str:
    """Error of each filter from the first sample on: ours answers at once, the simplified one after 50 s."""
    time_s = np.arange(1, len(found.truth) + 1) / LITERAL.rate_hz
    shown = time_s <= SHOWN_S[0]
    lines = {
        name: _points(time_s[shown], (getattr(found, name) - found.truth)[shown]) for name in COLOURS if name != "truth"
    }
    lines["ours, claimed deviation"] = _points(time_s[shown], found.ours_std[shown])
    colours = COLOURS | {"ours, claimed deviation": "#8fc1e8"}
    title = f"Error in the first minute while {name}"
    return line_chart(title, "time, s", "error of flexion, deg", lines, from_zero=False, colours=colours)


def _points(time_s: Array, angle: Array) -> list[tuple[float, float]]:
    wrapped = np.degrees(np.angle(np.exp(1j * angle)))
    return list(zip(time_s.tolist(), wrapped.tolist(), strict=True))
