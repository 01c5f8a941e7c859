"""Scoreboards by the name that `ambula bench` takes."""

from collections.abc import Callable
from pathlib import Path

from services.bench.scoreboard import Scoreboard


def accuracy(json_path: Path | None = None, *subject: str) -> Scoreboard:
    """Joint angles against optical motion capture, all estimators side by side."""
    from services.bench.accuracy.board import run

    return run(json_path, *subject)


def step(json_path: Path | None = None) -> Scoreboard:
    """Time of one filter step, compiled against textbook."""
    from services.bench.performance.step import run

    return run(json_path)


def chain(json_path: Path | None = None) -> Scoreboard:
    """What a frame of five sensors costs in each node of the plain loop."""
    from services.bench.performance.chain import run

    return run(json_path)


def rhythm(json_path: Path | None = None) -> Scoreboard:
    """Rhythm estimators on random and on walking motions."""
    from services.bench.rhythm.board import run

    return run(json_path)


def joukov(json_path: Path | None = None, *subject: str, report: Path | None = None) -> Scoreboard:
    """The Rhythmic EKF's paper, repeated: how many motions, and parts of it, e.g. 100 tables; all without a part."""
    from services.bench.joukov.board import MOTIONS, PARTS, run

    numbers = [word for word in subject if word.isdecimal()]
    parts = [word for word in subject if not word.isdecimal()]
    unknown = [part for part in parts if part not in PARTS]
    if unknown or len(numbers) > 1:
        known = ", ".join(PARTS)
        raise ValueError(f"joukov takes a number of motions and parts of {known}, not {' '.join(subject)!r}")
    return run(json_path, int(numbers[0]) if numbers else MOTIONS, parts, report)


def loss(json_path: Path | None = None, *subject: str) -> Scoreboard:
    """What lost samples cost: bursts on the radio, sensors and receivers silent in mid-walk."""
    from services.bench.performance.loss import run

    return run(json_path, *subject)


def recovery(json_path: Path | None = None) -> Scoreboard:
    """What a kill of the archive costs, before and after its restart, and what a flush costs."""
    from services.bench.performance.recovery import run

    return run(json_path)


def repetitions(json_path: Path | None = None, *subject: str) -> Scoreboard:
    """Repetitions of knee exercises: counts, ranges and boundaries against what was done."""
    from services.bench.repetitions.board import run

    return run(json_path, *subject)


def strides(json_path: Path | None = None, *subject: str) -> Scoreboard:
    """Stride counts and event times against reviewed contacts and synthetic walks."""
    from services.bench.gait.strides import run

    return run(json_path, *subject)


def events(json_path: Path | None = None, *subject: str) -> Scoreboard:
    """Initial contact and toe-off by shanks, feet and lower back against what others saw."""
    from services.bench.gait.events import run

    return run(json_path, *subject)


def walks(json_path: Path | None = None, walks: str = "2") -> Scoreboard:
    """The whole filter on synthetic walks: over the process noise, where the stride breaks off, and its deviations."""
    from services.bench.joukov.walks import run

    if not walks.isdecimal():
        raise ValueError(f"walks takes a number of walks, e.g. 2, not {walks!r}")
    return run(json_path, int(walks))


def knee(json_path: Path | None = None, *subject: str, report: Path | None = None) -> Scoreboard:
    """The two-sensor knee: axis, angle and cost against optical truth, published methods and libraries."""
    from services.bench.knee.board import run

    return run(json_path, *subject, report=report)


def tug(json_path: Path | None = None, *subject: str) -> Scoreboard:
    """Phases of the timed up and go against exact truth; rises against cameras; walks that hold none."""
    from services.bench.tug.board import run

    return run(json_path, *subject)


def kinect(json_path: Path | None = None, *subject: str, report: Path | None = None) -> Scoreboard:
    """The whole body from a depth camera: simulated tasks, recordings, methods side by side, cost."""
    from services.bench.kinect.board import run

    return run(json_path, *subject, report=report)


def exercises(json_path: Path | None = None, *subject: str) -> Scoreboard:
    """Squats, steps and tilts before a camera, and gait from a camera, against simulated truth."""
    from services.bench.exercises.board import run

    return run(json_path, *subject)


def metrics(json_path: Path | None = None, *section: str, report: Path | None = None) -> Scoreboard:
    """Metrics, progress, report and exports against what is known."""
    from services.bench.metrics.board import run

    return run(json_path, *section, report=report)


def walking_tests(json_path: Path | None = None, *subject: str) -> Scoreboard:
    """Six-minute and ten-metre walks: distance, turns, rests and speed in the timed zone against what was walked."""
    from services.bench.walking_tests.board import run

    return run(json_path, *subject)


def web(json_path: Path | None = None, *subject: str) -> Scoreboard:
    """The web application under load: delay from sensor to browser, one who never reads, a flood, the live page."""
    from services.bench.web.board import run

    return run(json_path, *subject)


SCOREBOARDS: dict[str, Callable[..., Scoreboard]] = {
    "accuracy": accuracy,
    "chain": chain,
    "events": events,
    "exercises": exercises,
    "joukov": joukov,
    "kinect": kinect,
    "knee": knee,
    "loss": loss,
    "metrics": metrics,
    "recovery": recovery,
    "repetitions": repetitions,
    "rhythm": rhythm,
    "step": step,
    "strides": strides,
    "tug": tug,
    "walking_tests": walking_tests,
    "walks": walks,
    "web": web,
}
