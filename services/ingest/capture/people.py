"""Persons behind tracking ids: a camera that loses somebody gives a new id, and may exchange two. Pure."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import SkeletonJoint
from services.ingest.capture.parameters import FOLLOWING, FollowingParameters

Array = NDArray[np.float64]

TRUNK = ("spine_base", "spine_mid", "spine_shoulder", "hip_right", "hip_left", "shoulder_right", "shoulder_left")
BONES = (
    ("spine_base", "spine_shoulder"), ("hip_right", "hip_left"),
    ("spine_shoulder", "shoulder_right"), ("shoulder_right", "elbow_right"), ("elbow_right", "wrist_right"),
    ("spine_shoulder", "shoulder_left"), ("shoulder_left", "elbow_left"), ("elbow_left", "wrist_left"),
    ("hip_right", "knee_right"), ("knee_right", "ankle_right"), ("hip_left", "knee_left"), ("knee_left", "ankle_left"),
)  # fmt: skip
SHORTEST_BONE = 0.01
"""m; shorter is none."""
LEAST_BONES = 3
"""Bones that two bodies must both have shown before their sizes are compared."""
VELOCITY_MEMORY_S = 0.3


@dataclass(frozen=True, slots=True)
class SeenBody:
    """One body of a frame, with the camera's own tracking id."""

    id: int
    position: Array
    """(joints, 3) m, axes of the room; NaN where the camera says nothing."""
    tracked: NDArray[np.bool_]
    """(joints,) seen, not inferred."""


class BodyMeasure:
    """Where a body is and how long its bones are."""

    def __init__(self, joints: Sequence[SkeletonJoint]) -> None:
        index = {joint.value: k for k, joint in enumerate(joints)}
        self._trunk = [index[name] for name in TRUNK if name in index]
        bones = [(index[a], index[b]) for a, b in BONES if a in index and b in index]
        self._from, self._to = [a for a, _ in bones], [b for _, b in bones]

    def place(self, body: SeenBody) -> Array | None:
        """(3,) m, median of the trunk's joints: one of them may be anywhere. None without any."""
        trunk = body.position[self._trunk]
        known = np.sort(trunk[np.isfinite(trunk[:, 0])], axis=0)
        return np.asarray(0.5 * (known[(len(known) - 1) // 2] + known[len(known) // 2])) if len(known) else None

    def log_lengths(self, body: SeenBody) -> Array:
        """(bones,) log of m; NaN where an end is not seen."""
        bone = body.position[self._to] - body.position[self._from]
        squared = np.einsum("bi,bi->b", bone, bone)
        usable = body.tracked[self._to] & body.tracked[self._from] & (squared > SHORTEST_BONE**2)
        return np.asarray(0.5 * np.log(np.where(usable, squared, np.nan)))


@dataclass(eq=False)
class Person:
    """Somebody who was seen, whatever ids the camera gave."""

    id: int
    first_ns: int
    last_ns: int
    place: Array
    log_lengths: Array
    velocity: Array = field(default_factory=lambda: np.zeros(3))
    """(3,) m/s."""
    settled_ns: int = 0
    """Session time since which it has stayed at `home`."""
    home: Array = field(default_factory=lambda: np.zeros(3))
    beside_ns: int = 0
    """ns in view together with the patient."""

    def take(self, now_ns: int, place: Array, log_lengths: Array, parameters: FollowingParameters) -> None:
        """It is seen again."""
        passed_s = (now_ns - self.last_ns) * 1e-9
        if passed_s > parameters.alive_s:
            self.velocity = np.zeros(3)
        elif passed_s > 0.0:
            share = min(1.0, passed_s / VELOCITY_MEMORY_S)
            self.velocity = self.velocity + share * ((place - self.place) / passed_s - self.velocity)
        share = min(1.0, passed_s / min(parameters.size_memory_s, max((now_ns - self.first_ns) * 1e-9, 1e-3)))
        mixed = self.log_lengths + share * (log_lengths - self.log_lengths)
        known = np.where(np.isnan(self.log_lengths), log_lengths, self.log_lengths)
        self.log_lengths = np.where(np.isnan(mixed), known, mixed)
        self.place, self.last_ns = place, now_ns
        # Over the floor alone: who squats or bends stays.
        if math.hypot(place[0] - self.home[0], place[2] - self.home[2]) > parameters.settle_m:
            self.home, self.settled_ns = place, now_ns

    def distance_m(self, place: Array, now_ns: int, coasting_s: float) -> float:
        """m from a place to the way between where it was seen last and where it would be by now."""
        way = self.velocity * min((now_ns - self.last_ns) * 1e-9, coasting_s)
        squared = float(way @ way)
        share = 0.0 if squared == 0.0 else min(1.0, max(0.0, float((place - self.place) @ way) / squared))
        return math.hypot(*(place - self.place - share * way))

    def size_difference(self, log_lengths: Array) -> float:
        """Median over bones of |log ratio|; 0 while too few bones are known to tell."""
        difference = np.abs(self.log_lengths - log_lengths)
        known = difference[~np.isnan(difference)]
        return float(np.median(known)) if len(known) >= LEAST_BONES else 0.0


class People:
    """Everybody in view and those who were lately. Times are session time, ns."""

    def __init__(self, joints: Sequence[SkeletonJoint], parameters: FollowingParameters = FOLLOWING) -> None:
        self._parameters = parameters
        self._measure = BodyMeasure(joints)
        self._people: list[Person] = []
        self._undecided: dict[int, Person] = {}

    def take(self, now_ns: int, bodies: Sequence[SeenBody]) -> list[Person | None]:
        """The person of each body of a frame; None for one of whom it is not yet decided whether it is new."""
        places = [self._measure.place(body) for body in bodies]
        lengths = [self._measure.log_lengths(body) for body in bodies]
        found: list[Person | None] = [None] * len(bodies)
        doubtful = []
        for k, (body, place) in enumerate(zip(bodies, places, strict=True)):
            person = self._by_id(body.id, now_ns)
            if place is None:
                continue
            if person is not None and self._goes_on(person, place, now_ns):
                found[k] = person
            else:
                doubtful.append((k, place))
        self._undecided = {bodies[k].id: self._look(bodies[k].id, now_ns, place, lengths[k]) for k, place in doubtful}
        self._recognise(now_ns, [(k, self._undecided[bodies[k].id]) for k, _ in doubtful], found)
        for k, person in enumerate(found):
            place = places[k]
            if person is not None and place is not None:
                person.id = bodies[k].id
                person.take(now_ns, place, lengths[k], self._parameters)
                self._undecided.pop(person.id, None)
        self._forget(now_ns)
        return found

    def forget_bystanders(self) -> None:
        """Nobody stands beside anybody any more."""
        for person in self._people:
            person.beside_ns = 0

    def _by_id(self, body_id: int, now_ns: int) -> Person | None:
        """Who had the id until just now; the newest, if an id was given twice."""
        alive_ns = self._parameters.alive_s * 1e9
        having = [each for each in self._people if each.id == body_id and now_ns - each.last_ns <= alive_ns]
        return max(having, key=lambda each: each.last_ns, default=None)

    def _goes_on(self, person: Person, place: Array, now_ns: int) -> bool:
        passed_s = (now_ns - person.last_ns) * 1e-9
        parameters = self._parameters
        believed_m = parameters.jump_m + parameters.fastest_m_s * passed_s
        return person.distance_m(place, now_ns, parameters.coasting_s) <= believed_m

    def _look(self, body_id: int, now_ns: int, place: Array, log_lengths: Array) -> Person:
        """A body that may be new, as it was seen so far."""
        known = self._undecided.get(body_id)
        if known is None or not self._goes_on(known, place, now_ns):
            return Person(body_id, now_ns, now_ns, place, log_lengths, settled_ns=now_ns, home=place)
        known.take(now_ns, place, log_lengths, self._parameters)
        return known

    def _recognise(self, now_ns: int, doubtful: list[tuple[int, Person]], found: list[Person | None]) -> None:
        """Give vanished persons the bodies most like them; who is near none of them, or was looked at long enough
        without being like them, is new."""
        vanished = [each for each in self._people if each not in found and self._is_awaited(each, now_ns)]
        costs = [
            (cost, k, person)
            for k, body in doubtful
            for person in vanished
            if (cost := self._unlikeness(person, body, now_ns)) is not None
        ]
        for cost, k, person in sorted(costs, key=lambda each: each[0]):
            if cost < np.inf and found[k] is None and person not in found:
                found[k] = person
        for k, body in doubtful:
            is_near = any(k == near for _, near, person in costs if person not in found)
            if found[k] is None and (not is_near or now_ns - body.first_ns >= self._parameters.decide_s * 1e9):
                found[k] = body
                self._people.append(body)

    def _is_awaited(self, person: Person, now_ns: int) -> bool:
        return now_ns - person.last_ns <= self._parameters.same_s * 1e9

    def _unlikeness(self, person: Person, body: Person, now_ns: int) -> float | None:
        """None out of reach; inf within reach but of another size."""
        parameters = self._parameters
        reach_m = parameters.reach_m + parameters.reach_growth_m_s * (now_ns - person.last_ns) * 1e-9
        distance = person.distance_m(body.place, now_ns, parameters.coasting_s) / reach_m
        if distance > 1.0:
            return None
        size = person.size_difference(body.log_lengths) / parameters.size_tolerance
        return distance + size if size <= 1.0 else np.inf

    def _forget(self, now_ns: int) -> None:
        """Those of long ago; and the longest away when there were too many."""
        kept = [each for each in self._people if self._is_awaited(each, now_ns)]
        self._people = sorted(kept, key=lambda each: each.last_ns)[-self._parameters.most_people :]
