"""What the operator chose about a session; whatever was not chosen is as the source says."""

from dataclasses import dataclass
from typing import Any

from schemas.conditions import Conditions
from schemas.rhythm import KnownRhythm
from schemas.session import SessionDescription, WalkPath
from schemas.vocabulary import (
    CAMERA_ESTIMATORS,
    ESTIMATORS,
    FUSION_ESTIMATORS,
    KNEE_ESTIMATORS,
    LOWER_BODY_ESTIMATORS,
    Task,
)
from services.biomech.event_sources import whole_legs, worn_segments
from services.ingest.errors import InvalidOption

LONGEST_WALKWAY_M = 100.0


@dataclass(frozen=True, slots=True)
class Choices:
    """None leaves a choice to the source. Raises InvalidOption for a choice that cannot be had."""

    estimator: str | None = None
    walk_path: WalkPath | None = None
    known_rhythms: tuple[KnownRhythm, ...] | None = None
    task: Task | None = None
    walkway_m: float | None = None
    conditions: Conditions | None = None

    def __post_init__(self) -> None:
        if self.estimator is not None and self.estimator not in ESTIMATORS:
            raise InvalidOption(f"estimator {self.estimator!r} is unknown; choose one of {', '.join(ESTIMATORS)}")
        known = self.known_rhythms
        if known is not None and len({each.kind for each in known}) < len(known):
            raise InvalidOption("known_rhythms: give at most one previous trial, one previous visit and one exemplar")
        if self.walkway_m is not None and not 0 < self.walkway_m <= LONGEST_WALKWAY_M:
            raise InvalidOption(f"walkway {self.walkway_m:g} m: give more than 0 and at most {LONGEST_WALKWAY_M:g} m")

    def applied(self, description: SessionDescription) -> SessionDescription:
        """A source's description with what was chosen. Raises InvalidOption for an estimator without its sensors."""
        chosen: dict[str, Any] = {
            "estimator": self.estimator,
            "walk_path": self.walk_path,
            "known_rhythms": None if self.known_rhythms is None else list(self.known_rhythms),
            "task": self.task,
            "walkway_m": self.walkway_m,
            "conditions": self.conditions,
        }
        if self.estimator is not None:
            lacking = missing_source(self.estimator, hubs=bool(description.hubs), cameras=bool(description.cameras))
            if lacking is not None:
                raise InvalidOption(lacking)
        if self.estimator in KNEE_ESTIMATORS and not whole_legs(worn_segments(description.hubs)):
            raise InvalidOption(
                f"estimator {self.estimator!r} needs a sensor on the thigh and one on the shank of one leg; assign the "
                f"sensors anew or choose one of {', '.join(LOWER_BODY_ESTIMATORS)}"
            )
        return description.model_copy(update={name: value for name, value in chosen.items() if value is not None})


def usual_estimator(*, hubs: bool, cameras: bool) -> str:
    """What is taken where nobody chose: the first that uses all there is."""
    if cameras:
        return next(iter(FUSION_ESTIMATORS if hubs else CAMERA_ESTIMATORS))
    return "rhythmic_ekf"


def missing_source(estimator: str, *, hubs: bool, cameras: bool) -> str | None:
    """What an estimator needs that the session does not have, and what to choose instead; None: nothing."""
    if estimator in FUSION_ESTIMATORS:
        if hubs and cameras:
            return None
        needed = "sensors and a camera"
    elif estimator in CAMERA_ESTIMATORS:
        if cameras:
            return None
        needed = "a camera"
    elif hubs:
        return None
    else:
        needed = "sensors on the body"
    able = [*(LOWER_BODY_ESTIMATORS if hubs else ()), *(CAMERA_ESTIMATORS if cameras else ())]
    has = "sensors only" if hubs and not cameras else "a camera only" if cameras and not hubs else "both"
    return f"estimator {estimator!r} needs {needed} and this session has {has}; choose one of {', '.join(able)}"


AS_THE_SOURCE_SAYS = Choices()
"""Nothing was chosen."""
