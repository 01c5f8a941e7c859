"""What tells the gait events of a leg, given the segments that wear a sensor: the best there is."""

from collections.abc import Iterable, Set

from schemas.session import HubDescription, SessionDescription
from schemas.vocabulary import CAMERA_ESTIMATORS, FUSION_ESTIMATORS, KNEE_ESTIMATORS, EventSource, Segment, Side


def worn_segments(hubs: Iterable[HubDescription]) -> frozenset[Segment]:
    """All segments with a sensor."""
    return frozenset(sensor.segment for hub in hubs for sensor in hub.sensors)


def whole_legs(worn: Set[Segment]) -> tuple[Side, ...]:
    """Legs with a sensor on both thigh and shank: those that can be knees of their own."""
    return tuple(side for side in Side if {Segment(f"thigh_{side}"), Segment(f"shank_{side}")} <= worn)


def used_segments(description: SessionDescription) -> frozenset[Segment]:
    """Segments whose sensors a session uses.

    All; with an estimator of single knees those of whole legs; with one of a camera alone none.
    """
    worn = worn_segments(description.hubs)
    if description.estimator in CAMERA_ESTIMATORS:
        return frozenset()
    if description.estimator not in KNEE_ESTIMATORS:
        return worn
    return frozenset(Segment(f"{part}_{side}") for side in whole_legs(worn) for part in ("thigh", "shank"))


def event_source(worn: Set[Segment], side: Side) -> EventSource:
    """The best source of one leg's events.

    The whole leg times them by the ankle, a shank or a foot by its own rotation, the lower back by how the trunk is
    caught at each contact. What is worn decides, not what speaks at the moment: each source is late or early by an
    amount of its own, and a stride timed by two of them would be wrong by the difference.
    """
    if {Segment.PELVIS, Segment(f"thigh_{side}"), Segment(f"shank_{side}")} <= worn:
        return EventSource.FULL_LEG
    if Segment(f"shank_{side}") in worn:
        return EventSource.SHANK
    if Segment(f"foot_{side}") in worn:
        return EventSource.FOOT
    return EventSource.LOWER_BACK if Segment.PELVIS in worn else EventSource.NOTHING


def event_sources(worn: Set[Segment]) -> dict[Side, EventSource]:
    """The same for both legs."""
    return {side: event_source(worn, side) for side in Side}


def uses_camera(description: SessionDescription) -> bool:
    """Whether a session's body is estimated from what a camera sees, alone or beside inertial sensors."""
    return bool(description.cameras) and description.estimator in CAMERA_ESTIMATORS | FUSION_ESTIMATORS


def session_event_sources(description: SessionDescription) -> dict[Side, EventSource]:
    """What tells the events of each leg in a session.

    Where a camera is used, it tells them, of both legs alike, unless each wears sensors on its shank at least: a foot
    or the lower back alone would be told by its own motion, which an estimate that shares the body with a camera does
    not publish.
    """
    sources = event_sources(used_segments(description))
    if not uses_camera(description):
        return sources
    by_sensors = (EventSource.FULL_LEG, EventSource.SHANK)
    both = all(source in by_sensors for source in sources.values())
    return sources if both else dict.fromkeys(Side, EventSource.CAMERA)


def session_lone_segments(description: SessionDescription) -> tuple[Segment, ...]:
    """Segments whose own motion tells events in a session."""
    return () if uses_camera(description) else lone_segments(used_segments(description))


def lone_segments(worn: Set[Segment]) -> tuple[Segment, ...]:
    """Segments whose own motion tells events: feet that are a leg's best source, the pelvis where it is."""
    sources = event_sources(worn)
    feet = [Segment(f"foot_{side}") for side, source in sources.items() if source is EventSource.FOOT]
    back = [Segment.PELVIS] if EventSource.LOWER_BACK in sources.values() else []
    return (*back, *feet)
