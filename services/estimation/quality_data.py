"""What a calibration says of how far its angles may be trusted, and which joints a session should see."""

from collections.abc import Set

from schemas.kinematics import Calibration
from schemas.vocabulary import LOWER_BODY, Misplacement, Segment, Side
from services.estimation.body.fitted_body import UNKNOWN
from services.estimation.knee.band import BAND_DATUM
from services.estimation.knee.published_axis import MCGRATH_DATUM
from services.estimation.lower_body.calibration_message import POPULATION

NOBODY_STOOD = (POPULATION, UNKNOWN)
UNKNOWN_CONSTANT = (*NOBODY_STOOD, BAND_DATUM, MCGRATH_DATUM)
"""Data of angles that carry a constant nobody knows."""

_PARTS = {
    Misplacement.SWAPPED: ("thigh", "shank"),
    Misplacement.THIGH_UPSIDE_DOWN: ("thigh",),
    Misplacement.SHANK_UPSIDE_DOWN: ("shank",),
    Misplacement.OTHER_LEG: ("thigh", "shank"),
}


def calibration_flags(calibration: Calibration) -> tuple[bool, bool]:
    """Whether angles refer to a standing that was seen or to an axis that was found; whether without a constant.

    Of two sources, as `sensors: ...; camera: ...`, the first leads.
    """
    datum = calibration.datum.split("; camera:")[0].removeprefix("sensors: ")
    calibrated = not any(words in datum for words in NOBODY_STOOD)
    return calibrated, calibration.absolute and not any(words in datum for words in UNKNOWN_CONSTANT)


def misplaced_segments(calibration: Calibration) -> frozenset[Segment]:
    """Segments whose sensors are worn otherwise than declared."""
    return frozenset(
        Segment(f"{part}_{side}")
        for side, kinds in calibration.misplaced.items()
        for kind in kinds
        for part in _PARTS[kind]
    )


def seen_by_sensors(worn: Set[Segment]) -> list[str]:
    """Coordinates of the lower body that sensors on these segments tell: a joint needs both its segments."""
    names = []
    for dof in LOWER_BODY:
        joint, side = dof.name.split("_")[0], dof.name.split("_")[-1]
        needed = {Segment.PELVIS} if joint == "pelvis" else _segments(joint, Side(side))
        names += [dof.name] if needed <= worn else []
    return names


def _segments(joint: str, side: Side) -> set[Segment]:
    thigh, shank = Segment(f"thigh_{side}"), Segment(f"shank_{side}")
    return {Segment.PELVIS, thigh} if joint == "hip" else {thigh, shank}


SEEN_BY_A_CAMERA = [f"{joint}_flexion_{side}" for joint in ("hip", "knee") for side in Side]
"""Coordinates that a depth camera should tell all the time; how a thigh turns about itself it does not see."""
