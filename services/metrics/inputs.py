"""Which sensors and cameras a number rests on: only those can speak against it."""

from collections.abc import Mapping, Sequence

from schemas.session import SessionDescription
from schemas.vocabulary import EventSource, Segment, Side
from services.biomech.event_sources import session_event_sources, used_segments, uses_camera
from services.definitions.definition import Basis, Definition
from services.definitions.strides import STRIDE_METRICS

BOTH_FEET = ("step_time", "initial_double_support", "terminal_double_support", "single_support", "double_support")
"""Beginnings of the names of measures that the other foot's events belong to."""

ANY_WILL_DO = "tug_"
"""Beginning of the names of measures that the pelvis, or either leg, tells alone."""

Sources = frozenset[str]
"""Names of sensors and cameras, all of them needed."""

_OF_STRIDES = {definition.name for definition in STRIDE_METRICS}


class Inputs:
    """Of one session."""

    def __init__(self, description: SessionDescription) -> None:
        used = used_segments(description)
        self._names: dict[Segment, str] = {}
        for hub in description.hubs:
            for sensor in hub.sensors:
                if sensor.segment in used:
                    self._names.setdefault(sensor.segment, sensor.name)
        self._events: Mapping[Side, EventSource] = session_event_sources(description)
        self.uses_camera = uses_camera(description)
        self._camera = frozenset([description.cameras[0].name]) if self.uses_camera else frozenset()

    def alternatives(self, definition: Definition, side: str | None) -> Sequence[Sources]:
        """Sets of sources any of which is enough; none where nothing is known of what it rests on."""
        if definition.name.startswith(ANY_WILL_DO) and not self.uses_camera:
            legs = [self._needed(Basis.KNEE, one) for one in Side]
            return [each for each in (self._worn(Segment.PELVIS), *legs) if each]
        sides = [Side(side)] if side else list(Side)
        is_of_both = definition.name.startswith(BOTH_FEET) or (side is None and not self._is_of_either(definition))
        needed = [self._needed(definition.basis, one) for one in (list(Side) if is_of_both else sides)]
        found = [frozenset().union(*needed)] if is_of_both else list(dict.fromkeys(needed))
        if self._camera and self._camera not in found:
            found.append(self._camera)
        return [each for each in found if each]

    def _is_of_either(self, definition: Definition) -> bool:
        return definition.basis is Basis.CONTACTS and definition.name.startswith(("stride_time", "cadence"))

    def _needed(self, basis: Basis, side: Side) -> Sources:
        leg = (Segment(f"thigh_{side}"), Segment(f"shank_{side}"))
        match basis:
            case Basis.CONTACTS | Basis.TOE_OFFS:
                return self._events_of(side)
            case Basis.LENGTHS:
                return self._worn(
                    Segment.PELVIS, *leg, *(Segment(f"{part}_{side.other}") for part in ("thigh", "shank"))
                )
            case Basis.HIP:
                return self._worn(Segment.PELVIS, leg[0])
            case Basis.PELVIS | Basis.TRUNK:
                return self._worn(Segment.PELVIS)
            case Basis.WIDTH | Basis.ANKLE:
                return self._camera
            case Basis.COUNT:
                return frozenset()
        return self._worn(*leg)

    def _events_of(self, side: Side) -> Sources:
        leg = (Segment(f"thigh_{side}"), Segment(f"shank_{side}"))
        return {
            EventSource.FULL_LEG: self._worn(Segment.PELVIS, *leg),
            EventSource.SHANK: self._worn(leg[1]),
            EventSource.FOOT: self._worn(Segment(f"foot_{side}")),
            EventSource.LOWER_BACK: self._worn(Segment.PELVIS),
            EventSource.CAMERA: self._camera,
            EventSource.NOTHING: frozenset(),
        }[self._events[side]]

    def _worn(self, *segments: Segment) -> Sources:
        return frozenset(self._names[segment] for segment in segments if segment in self._names)
