"""What one session of a task consists of, as joint angles at 30 Hz: standing, repetitions, pauses, natural drift."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d
from scipy.signal import butter, filtfilt

from services.biomech.whole_body.model import DOF
from services.ingest.synthetic.whole_body.manners import MANNERS, SQUAT, STEPS, TWO_SIDED, USUAL_S, Manner
from services.ingest.synthetic.whole_body.people import Person
from services.ingest.synthetic.whole_body.progress import Progress

Array = NDArray[np.float64]

RATE_HZ = 30.0
PARTIAL_RANGE = (0.3, 0.42)
"""Share of its range that a partial repetition reaches."""
LEAST_S = 0.6
"""s there and back, however high the tempo and long the holds."""
MISSED_BEGINNING = 0.35
"""Share of the first repetition that is over when a session begins without standing."""
LAST_S = 1.0
"""s of standing at the end."""
HINGE_LEAST_DEG = 0.3
"""Of knees and elbows."""


@dataclass(frozen=True)
class Programme:
    """What is asked for. Without a word: ten repetitions as each person does them, after 3 s of standing."""

    repetitions: int = 10
    standing_s: float = 3.0  # 0 begins within a repetition, which does not count
    period_s: float | None = None  # from one repetition to the next, holds and pauses included; None: the person's own
    hold_s: float = 0.0  # at the far side; of tasks of two sides at both
    pause_s: float = 0.0  # after each repetition, beside the person's own 0.2 to 0.8 s
    set_of: int = 0  # repetitions of a set; 0: one set of all
    rest_s: float = 5.0  # between sets
    asymmetry: float = 0.0  # share by which the left side moves less
    fatigue: float = 0.0  # share of the range that is lost by the end
    slowing: float = 0.0  # share of the tempo that is lost by the end
    partials: float = 0.0  # share of repetitions that go less than half as far


AS_IN_THE_PAPER = Programme()


class Performance(NamedTuple):
    """What a person did, n frames at 30 Hz."""

    angles: Array  # (n, 22) rad
    repetition: Array  # (n,) number from 1, negative where partial, 0 in none
    side: Array  # (n,) 1 to the right, -1 to the left, 0 neither


class _Part(NamedTuple):
    angles: Array  # (n, 22) deg away from standing
    repetition: int
    side: Array


def perform(
    who: Person,
    task: int,
    rng: np.random.Generator,
    programme: Programme = AS_IN_THE_PAPER,
    manners: Mapping[int, Manner] = MANNERS,
) -> Performance:
    """A session of a task. What the programme asks beyond the usual is drawn apart: the rest stays the same."""
    extra = rng.spawn(1)[0]
    parts = [_still(programme.standing_s)]
    for k in range(programme.repetitions):
        amplitude = who.amplitude * (1.0 + 0.05 * rng.normal())
        parts.append(_repetition(k, amplitude, (who, task, rng, extra), programme, manners[task]))
        pause = 0.1 if task == STEPS else rng.uniform(0.2, 0.8)
        last_of_set = programme.set_of and (k + 1) % programme.set_of == 0 and k + 1 < programme.repetitions
        parts.append(_still(pause + programme.pause_s + (programme.rest_s if last_of_set else 0.0)))
    parts.append(_still(LAST_S))
    return Performance(
        _drifting(who, rng, np.concatenate([part.angles for part in parts])),
        np.concatenate([np.full(len(part.angles), float(part.repetition)) for part in parts]),
        np.concatenate([part.side for part in parts]),
    )


def _still(seconds: float) -> _Part:
    frames = int(RATE_HZ * seconds)
    return _Part(np.zeros((frames, len(DOF))), 0, np.zeros(frames))


def _repetition(
    k: int,
    amplitude: float,
    of: tuple[Person, int, np.random.Generator, np.random.Generator],
    programme: Programme,
    manner: Manner,
) -> _Part:
    who, task, rng, extra = of
    done = k / max(programme.repetitions - 1, 1)
    partial, reach = extra.uniform() < programme.partials, extra.uniform(*PARTIAL_RANGE)
    amplitude *= (1.0 - programme.fatigue * done) * (reach if partial else 1.0)
    seconds = _moving_s(who, task, programme) / (1.0 - programme.slowing * done)
    progress = Progress.plain(int(RATE_HZ * seconds * (1.0 + 0.06 * rng.normal())))
    if programme.hold_s:
        progress = progress.held(int(RATE_HZ * programme.hold_s), twice=task in TWO_SIDED)
    angles = _asymmetric(manner(who, rng, amplitude, progress), progress, task, programme.asymmetry)
    side = np.where(progress.whole < 0.5, 1.0, -1.0) if task in TWO_SIDED else np.zeros(len(angles))
    number = -k - 1 if partial else k + 1
    if k == 0 and programme.standing_s == 0.0:
        left = progress.whole >= MISSED_BEGINNING
        return _Part(angles[left], 0, np.zeros(int(left.sum())))
    return _Part(angles, number, side)


def _moving_s(who: Person, task: int, programme: Programme) -> float:
    """s there and back, before it varies."""
    if programme.period_s is None:
        return USUAL_S[task] * who.tempo
    holds = 2 if task in TWO_SIDED else 1
    pause = 0.1 if task == STEPS else 0.5
    return max(programme.period_s - holds * programme.hold_s - pause - programme.pause_s, LEAST_S)


def _asymmetric(angles: Array, progress: Progress, task: int, asymmetry: float) -> Array:
    """The left side moves less: in tasks of two sides the half that goes there, in a squat the left leg and arm."""
    if asymmetry:
        if task in TWO_SIDED:
            angles[progress.whole >= 0.5] *= 1.0 - asymmetry
        elif task == SQUAT:
            angles[:, [i for name, i in DOF.items() if name.endswith("_left")]] *= 1.0 - asymmetry
    return angles


def _drifting(who: Person, rng: np.random.Generator, away_deg: Array) -> Array:
    """rad: about the person's own standing posture, smoothed, with natural drift."""
    angles = uniform_filter1d(who.rest_deg + away_deg, 5, axis=0, mode="nearest")
    return np.radians(hinged(angles + natural_drift_deg(rng, len(angles))))


def natural_drift_deg(rng: np.random.Generator, frames: int) -> Array:
    """(frames, 22) slow drift of 0.8 to 2 deg."""
    sway = np.array([0.8 if name.startswith(("pelvis", "hip", "clavicle")) else 1.2 for name in DOF])
    sway[[i for i, name in enumerate(DOF) if "shoulder_internal" in name]] = 2.0
    return np.asarray(slow_noise(rng, frames, len(DOF)) * sway)


def hinged(angles_deg: Array) -> Array:
    """The same with knees and elbows that do not overextend."""
    hinges = [i for i, name in enumerate(DOF) if name.startswith(("knee", "elbow"))]
    angles_deg[:, hinges] = np.maximum(angles_deg[:, hinges], HINGE_LEAST_DEG)
    return angles_deg


def slow_noise(rng: np.random.Generator, frames: int, columns: int, cutoff_hz: float = 0.4) -> Array:
    """(frames, columns) of unit variance below a frequency."""
    edge = 300
    white = rng.normal(size=(frames + 2 * edge, columns))
    low = filtfilt(*butter(2, cutoff_hz / (RATE_HZ / 2.0)), white, axis=0)[edge:-edge]
    return np.asarray(low / low.std(axis=0))
