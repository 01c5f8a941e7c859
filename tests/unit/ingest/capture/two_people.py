"""Simulated people in front of a depth camera, each a standing figure that is moved about and seen with noise."""

import numpy as np

from schemas.vocabulary import JointCentre, SkeletonJoint
from services.ingest.capture.following import Follower
from services.ingest.capture.people import SeenBody

JOINTS = [SkeletonJoint(centre) for centre in JointCentre]
RATE = 30.0
FRAME_NS = round(1e9 / RATE)

# x to the camera, y up, z right of who faces it; of a person 1 m tall whose spine_base is the origin.
_FIGURE = {
    "spine_base": (0, 0, 0), "spine_mid": (0, 0.16, 0), "spine_shoulder": (0, 0.29, 0),
    "shoulder": (0, 0.29, 0.1), "elbow": (0, 0.12, 0.13), "wrist": (0, -0.03, 0.14),
    "hip": (0, 0, 0.05), "knee": (0, -0.245, 0.05), "ankle": (0, -0.49, 0.05),
}  # fmt: skip


def figure(height):
    """(15, 3) m about spine_base."""
    rows = []
    for joint in JOINTS:
        name, _, side = joint.value.rpartition("_")
        x, y, z = _FIGURE[name] if side in ("left", "right") else _FIGURE[joint.value]
        rows.append((x, y, -z if side == "left" else z))
    return height * np.array(rows, dtype=float)


class Actor:
    """Somebody of a height who is at `where(t)` (x, z in m) with the id `ids(t)`; id None is not seen."""

    def __init__(self, height, where, ids):
        self.figure = figure(height)
        self.where = where if callable(where) else lambda _t: where
        self.ids = ids if callable(ids) else lambda _t: ids

    def body(self, t, rng, noise):
        number = self.ids(t)
        if number is None:
            return None
        x, z = self.where(t)
        position = self.figure + np.array([x, 0.0, z]) + rng.normal(0.0, noise, self.figure.shape)
        return SeenBody(number, position, np.ones(len(JOINTS), dtype=bool))


def play(actors, seconds, *, noise=0.02, seed=1, order=None, drop=0.0):
    """[(t, number, followed actor or None)] of a fresh follower; the actors' order in a frame is shuffled."""
    rng = np.random.default_rng(seed)
    follower = Follower(JOINTS)
    told = []
    for k in range(round(seconds * RATE)):
        t = k / RATE
        seen = [(actor, body) for actor in actors if (body := actor.body(t, rng, noise)) is not None]
        if rng.random() < drop:
            continue
        rng.shuffle(seen)
        number, place = follower.take(k * FRAME_NS, [body for _, body in seen])
        told.append((t, number, None if place is None else seen[place][0]))
    return told


def between(told, begin, end):
    return [(number, actor) for t, number, actor in told if begin <= t < end]


def ids(*spans):
    """Id by time: (from s, id) spans."""

    def of(t):
        return [number for begin, number in spans if t >= begin][-1]

    return of


def walk(*points):
    """Place by time: (s, x, z) points, straight in between."""
    t, x, z = zip(*points, strict=True)
    return lambda now: (float(np.interp(now, t, x)), float(np.interp(now, t, z)))
