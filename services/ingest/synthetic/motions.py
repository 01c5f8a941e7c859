"""The synthetic motions by name."""

from collections.abc import Callable

from services.ingest.errors import UnknownSource
from services.ingest.synthetic.block import SimulatedSession
from services.ingest.synthetic.corridor import SyntheticSixMinutes, SyntheticTenMetres
from services.ingest.synthetic.corridor_parameters import SixMinutesParameters, TenMetresParameters
from services.ingest.synthetic.kinds import PLAIN
from services.ingest.synthetic.knee_flexion import SyntheticKnee
from services.ingest.synthetic.march import SyntheticMarch
from services.ingest.synthetic.parameters import KneeParameters, MarchParameters, TugParameters, WalkParameters
from services.ingest.synthetic.patients.walk import PatientWalk
from services.ingest.synthetic.tug import SyntheticTug
from services.ingest.synthetic.walk import SyntheticWalk
from services.ingest.synthetic.whole_body.parameters import (
    SquatParameters,
    StepsParameters,
    TaskParameters,
    TiltAsideParameters,
    TiltForwardParameters,
)


def _walk(parameters: WalkParameters) -> SimulatedSession:
    return SyntheticWalk(parameters) if parameters.patient == PLAIN else PatientWalk(parameters)


def _task(parameters: TaskParameters) -> SimulatedSession:
    # The body's kinematics bring a compiler along, which an ingest without such a session does without.
    from services.ingest.synthetic.whole_body.exercise import SyntheticTask

    return SyntheticTask(parameters)


MOTIONS: dict[str, Callable[[str], SimulatedSession]] = {
    "walk": lambda options: _walk(WalkParameters.parse(options)),
    "march": lambda options: SyntheticMarch(MarchParameters.parse(options)),
    "knee": lambda options: SyntheticKnee(KneeParameters.parse(options)),
    "six_minutes": lambda options: SyntheticSixMinutes(SixMinutesParameters.parse(options)),
    "ten_metres": lambda options: SyntheticTenMetres(TenMetresParameters.parse(options)),
    "tug": lambda options: SyntheticTug(TugParameters.parse(options)),
    "squat": lambda options: _task(SquatParameters.parse(options)),
    "steps": lambda options: _task(StepsParameters.parse(options)),
    "tilt_forward": lambda options: _task(TiltForwardParameters.parse(options)),
    "tilt_aside": lambda options: _task(TiltAsideParameters.parse(options)),
}


def parse_motion(name: str, options: str) -> SimulatedSession:
    """The session of a motion with options such as `speed=1.1&seed=3`. Raises SourceError."""
    if name not in MOTIONS:
        known = " and ".join(f"synthetic:{motion}" for motion in MOTIONS)
        raise UnknownSource(f"synthetic:{name[:40]} is unknown; there are {known}")
    return MOTIONS[name](options)
