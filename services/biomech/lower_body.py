"""The lower body as a tree of one-axis joints, and where the sensors sit on it.

Frames are ISB: x forward, y up, z right, for the world and every segment. The pelvis frame has its origin midway
between the hip centres. Degrees of freedom, their order and their positive directions are those of the vocabulary;
the rotations of one joint follow each other in that order.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.session import Anthropometry
from schemas.vocabulary import LOWER_BODY, DegreeOfFreedom, Segment
from services.biomech.bones import SEGMENTS
from services.biomech.kernels.tables import Body, Sensors

Array = NDArray[np.float64]

PARENT_SEGMENT = {
    Segment.THIGH_RIGHT: Segment.PELVIS,
    Segment.THIGH_LEFT: Segment.PELVIS,
    Segment.SHANK_RIGHT: Segment.THIGH_RIGHT,
    Segment.SHANK_LEFT: Segment.THIGH_LEFT,
}

TRANSLATIONS = (
    DegreeOfFreedom("pelvis_forward", (1, 0, 0), "along world x"),
    DegreeOfFreedom("pelvis_up", (0, 1, 0), "along world y"),
    DegreeOfFreedom("pelvis_right", (0, 0, 1), "along world z"),
)
"""Position of the pelvis, m. Part of the dynamic model only, and never reported."""


class SensorMount(NamedTuple):
    """One sensor on its segment."""

    segment: Segment
    R_segment_from_sensor: Array
    position: tuple[float, float, float] | None = None


DEFAULT_POSITION = {
    Segment.PELVIS: (-0.10, 0.10, 0.0),
    Segment.THIGH_RIGHT: (0.03, -0.22, 0.07),
    Segment.THIGH_LEFT: (0.03, -0.22, -0.07),
    Segment.SHANK_RIGHT: (0.03, -0.15, 0.03),
    Segment.SHANK_LEFT: (0.03, -0.15, -0.03),
}
"""m, where a sensor usually sits when the description does not say. Only the dynamic accelerometer rows use it."""


def segment_of(dof: DegreeOfFreedom) -> Segment:
    """The segment that a degree of freedom moves against its parent."""
    if dof.name.startswith("pelvis"):
        return Segment.PELVIS
    side = dof.name.rpartition("_")[2]
    return Segment(f"thigh_{side}" if dof.name.startswith("hip") else f"shank_{side}")


@dataclass(frozen=True)
class LowerBodyModel:
    """Joints of the lower body in the order of the filter's state.

    `translations` adds the three of the pelvis (needed by dynamic accelerometer rows); `soft_knees` keeps
    ab/adduction and rotation of the knees. With translations and without soft knees it is the 14-dof model of
    Joukov; without translations and with soft knees its 15 dofs are exactly the vocabulary's LOWER_BODY.
    """

    anthropometry: Anthropometry
    translations: bool = False
    soft_knees: bool = True

    @cached_property
    def dofs(self) -> tuple[DegreeOfFreedom, ...]:
        """Degrees of freedom, translations first."""
        rotations = tuple(dof for dof in LOWER_BODY if self.soft_knees or not _is_soft(dof))
        return (TRANSLATIONS if self.translations else ()) + rotations

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of `dofs`."""
        return tuple(dof.name for dof in self.dofs)

    @property
    def first_rotation(self) -> int:
        """Index of pelvis_rotation in `dofs`."""
        return len(TRANSLATIONS) if self.translations else 0

    @cached_property
    def reported(self) -> NDArray[np.int64]:
        """(15,) index in `dofs` of each LOWER_BODY degree of freedom; -1 where the model has none."""
        place = {name: i for i, name in enumerate(self.names)}
        return np.array([place.get(dof.name, -1) for dof in LOWER_BODY])

    @cached_property
    def soft(self) -> NDArray[np.int64]:
        """Indices in `dofs` of the soft knee degrees of freedom."""
        return np.array([i for i, dof in enumerate(self.dofs) if _is_soft(dof)], dtype=np.int64)

    @cached_property
    def _joints(self) -> dict[Segment, list[int]]:
        first = self.first_rotation
        joints: dict[Segment, list[int]] = {segment: [] for segment in SEGMENTS}
        for i, dof in enumerate(self.dofs[first:]):
            joints[segment_of(dof)].append(first + i)
        return joints

    def joints_of(self, segment: Segment) -> list[int]:
        """Indices in `dofs` of the rotations between a segment and its parent."""
        return self._joints[segment]

    def last_joint(self, segment: Segment) -> int:
        """Index in `dofs` of the joint whose frame is the segment's."""
        return self._joints[segment][-1]

    def offset_of(self, segment: Segment) -> tuple[float, float, float]:
        """m, the segment's proximal joint in its parent's frame."""
        if segment is Segment.PELVIS:
            return (0.0, 0.0, 0.0)
        if PARENT_SEGMENT[segment] is Segment.PELVIS:
            half = self.anthropometry.hip_width_m / 2.0
            return (0.0, 0.0, half if segment is Segment.THIGH_RIGHT else -half)
        return (0.0, -self.anthropometry.thigh_length_m, 0.0)

    @cached_property
    def body(self) -> Body:
        """Joint table for the kernels."""
        n = len(self.dofs)
        axes = np.array([dof.axis for dof in self.dofs], dtype=np.float64)
        parent, offset = np.arange(-1, n - 1), np.zeros((n, 3))
        for segment, carrier in PARENT_SEGMENT.items():
            first = self.joints_of(segment)[0]
            parent[first] = self.last_joint(carrier)
            offset[first] = self.offset_of(segment)
        axis = np.abs(axes).argmax(axis=1)
        return Body(parent, axis, axes[np.arange(n), axis].copy(), offset, self.first_rotation)

    def sensors(self, mounts: Sequence[SensorMount]) -> Sensors:
        """Sensor table for the kernels, in the order of `mounts`."""
        paths = [self.path(self.last_joint(mount.segment)) for mount in mounts]
        table = np.full((len(mounts), max((len(path) for path in paths), default=1)), -1, dtype=np.int64)
        for row, path in zip(table, paths, strict=True):
            row[: len(path)] = path
        return Sensors(
            joint=np.array([self.last_joint(mount.segment) for mount in mounts], dtype=np.int64),
            rotation=np.array([mount.R_segment_from_sensor for mount in mounts]).reshape(-1, 3, 3),
            position=np.array([mount.position or DEFAULT_POSITION[mount.segment] for mount in mounts]).reshape(-1, 3),
            path=table,
            path_length=np.array([len(path) for path in paths], dtype=np.int64),
        )

    def path(self, joint: int) -> list[int]:
        """Joints from the root to `joint`."""
        parent = self.body.parent
        path = [joint]
        while parent[path[0]] >= 0:
            path.insert(0, int(parent[path[0]]))
        return path


def _is_soft(dof: DegreeOfFreedom) -> bool:
    return dof.name.startswith(("knee_adduction", "knee_internal_rotation"))
