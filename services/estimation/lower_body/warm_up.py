"""Compile what runs per sample before the first sample comes: with an empty cache it takes about a minute."""

import numpy as np

from schemas.conditions import UNSAID
from schemas.session import Anthropometry, HubDescription, Placement, SensorDescription, SessionDescription
from schemas.vocabulary import LOWER_BODY_ESTIMATORS, Task
from services.biomech.bones import SEGMENTS
from services.estimation.alignment import Alignment
from services.estimation.lower_body.lower_body_filter import Calibrated, LowerBodyFilter
from services.estimation.parameters import EstimationParameters
from services.estimation.samples import Tick


def warm_up() -> None:
    """Run every estimator for two ticks of an imagined session."""
    sensors = [
        SensorDescription(
            name=segment.value, segment=segment, rate_hz=100.0, outward_axis=[0.0, 0.0, 1.0], upward_axis=None,
            placement=Placement.UNKNOWN, position_in_segment=None,
        )
        for segment in SEGMENTS
    ]  # fmt: skip
    everyone = np.ones(len(sensors), dtype=np.bool_)
    frames = np.tile(np.eye(3), (len(sensors), 1, 1))
    calibrated = Calibrated(Alignment(frames, np.ones(len(sensors)), everyone), np.zeros((len(sensors), 3)))
    upright = np.tile([0.0, 0.0, 0.0, 0.0, 9.81, 0.0], (len(sensors), 1))
    for estimator in LOWER_BODY_ESTIMATORS:
        session = _session(estimator, sensors)
        running = LowerBodyFilter(session, sensors, calibrated, EstimationParameters().filter_of(session))
        for captured_ns in (0, 10_000_000):
            running.fuse(Tick(captured_ns, upright, everyone))


def _session(estimator: str, sensors: list[SensorDescription]) -> SessionDescription:
    body = Anthropometry(
        height_m=None, mass_kg=None, thigh_length_m=0.42, shank_length_m=0.42, hip_width_m=0.18, source="default"
    )
    return SessionDescription(
        session="warm-up", title="", started_unix_ns=0, origin="synthetic", protocol="", task=Task.WALK,
        walkway_m=None, conditions=UNSAID,
        estimator=estimator, walk_path="turning", hubs=[HubDescription(name="none", sensors=sensors)],
        cameras=[],
        anthropometry=body, standing=[], reference=[], duration_s=None, known_rhythms=[],
    )  # fmt: skip
