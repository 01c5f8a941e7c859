"""Which of the bodies in view is the patient. Pure; times are session time, ns."""

from collections.abc import Sequence
from typing import NamedTuple

from schemas.vocabulary import SkeletonJoint
from services.ingest.capture.parameters import FOLLOWING, FollowingParameters
from services.ingest.capture.people import People, Person, SeenBody


class Followed(NamedTuple):
    """The patient in one frame."""

    number: int | None
    """Counts the persons followed so far, from 1; None when nobody is followed in this frame."""
    place: int | None
    """Of the patient among the bodies given."""


NOBODY = Followed(None, None)


class Follower:
    """Follows one person.

    It is whoever stands nearest to the camera's axis and stays. The person is followed as long as its id goes on from
    where it was, and taken over under a new id that appears soon, near and of the same size. Somebody who was in view
    together with the patient is a bystander: not chosen until the patient has been away for long.
    """

    def __init__(self, joints: Sequence[SkeletonJoint], parameters: FollowingParameters = FOLLOWING) -> None:
        self._parameters = parameters
        self._people = People(joints, parameters)
        self._patient: Person | None = None
        self._number = 0
        self._last_ns = 0

    def take(self, now_ns: int, bodies: Sequence[SeenBody]) -> Followed:
        """The patient among the bodies of the next frame."""
        people = self._people.take(now_ns, bodies)
        if self._patient is None or self._patient not in people:
            self._choose(now_ns, [person for person in people if person is not None])
        if self._patient is None or self._patient not in people:
            self._last_ns = now_ns
            return NOBODY
        for person in people:
            if person is not None and person is not self._patient:
                person.beside_ns += now_ns - max(self._last_ns, person.first_ns)
        self._last_ns = now_ns
        return Followed(self._number, people.index(self._patient))

    def _choose(self, now_ns: int, people: Sequence[Person]) -> None:
        """Somebody, unless the patient may come back or the best placed has not stayed yet."""
        parameters = self._parameters
        away_ns = now_ns if self._patient is None else now_ns - self._patient.last_ns
        if self._patient is not None and away_ns <= parameters.same_s * 1e9:
            return
        if self._patient is None or away_ns > parameters.gone_s * 1e9:
            candidates = list(people)
        else:
            candidates = [each for each in people if each.beside_ns < parameters.beside_s * 1e9]
        best = min(candidates, key=self._off_centre_m, default=None)
        if best is not None and (
            now_ns - best.settled_ns >= parameters.settle_s * 1e9
            or now_ns - best.first_ns >= parameters.impatient_s * 1e9
        ):
            self._patient = best
            self._number += 1
            self._people.forget_bystanders()

    def _off_centre_m(self, person: Person) -> float:
        """m from the camera's axis, more for those further away."""
        x, _, z = person.place
        return float(abs(z) + self._parameters.distance_weight * abs(x))
