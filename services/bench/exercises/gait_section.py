"""Walks before a camera: events, strides, steps and speed against the simulated walker's."""

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from rich.progress import track

from schemas.gait import GaitEvent, Stride
from schemas.vocabulary import GaitEventKind, Side
from services.bench.exercises.seen_walks import seen_walk
from services.bench.exercises.sessions import through_chain
from services.bench.gait.joint_walks import JointWalk, joint_walk
from services.bench.scoreboard import Row, at_least, at_most, informative
from services.segmentation.node import build

SPEEDS = (0.6, 0.8, 1.0, 1.2, 1.4)
FIRST_SEED = 101
"""Nothing was chosen on the walks from here on."""
WITHIN_S = 0.15
"""s by which an event may be off to be found."""
AFTER_S = 0.2
"""s after a contact at which the true ankle is where the foot was put."""
NOISE_M, OFFSET_M = 0.012, 0.03
"""m, the errors of joint centres as given: those that pass, and those that stay."""


@dataclass
class Walks:
    """Sums over walks; errors are found minus true."""

    true: int = 0
    found: int = 0
    told: int = 0
    contacts: list[float] = field(default_factory=list)  # s
    toe_offs: list[float] = field(default_factory=list)  # s
    speeds: list[float] = field(default_factory=list)  # m/s, of whole walks
    cadences: list[float] = field(default_factory=list)  # steps/min, of whole walks
    steps: list[float] = field(default_factory=list)  # m
    strides: list[float] = field(default_factory=list)  # m
    stances: list[float] = field(default_factory=list)  # share of the stride, of whole walks
    strides_true: int = 0
    strides_valid: int = 0

    def add(self, walk: JointWalk, events: list[GaitEvent], strides: list[Stride]) -> None:
        """One walk."""
        for side in Side:
            for kind, true, errors in (
                (GaitEventKind.INITIAL_CONTACT, walk.contacts_s(side), self.contacts),
                (GaitEventKind.TOE_OFF, walk.toe_offs_s(side), self.toe_offs),
            ):
                self._events([one for one in events if one.side is side and one.kind is kind], true, errors)
            self.strides_true += len(walk.contacts_s(side)) - 1
        valid = [stride for stride in strides if stride.valid]
        self.strides_valid += len(valid)
        for stride in valid:
            self._lengths(walk, stride)
        self._means(walk, valid)

    def _events(self, found: list[GaitEvent], true: np.ndarray, errors: list[float]) -> None:
        times = np.array([one.captured_ns / 1e9 for one in found])
        self.true += len(true)
        self.told += len(times)
        for at in true:
            off = times[np.argmin(np.abs(times - at))] - at if len(times) else np.inf
            if abs(off) <= WITHIN_S:
                self.found += 1
                errors.append(float(off))

    def _lengths(self, walk: JointWalk, stride: Stride) -> None:
        """Where the walker's own ankles stood on its ground."""

        def put(side: Side, contact_ns: int) -> float:
            way = walk.body.ankle(side).position[:, 0]
            return float(np.interp(contact_ns / 1e9 + AFTER_S, walk.track.time_s, way))

        end, side = put(stride.side, stride.end_ns), stride.side
        if stride.stride_length_m is not None:
            self.strides.append(stride.stride_length_m - (end - put(side, stride.start_ns)))
        if stride.step_length_m is not None and stride.opposite_contact_ns is not None:
            self.steps.append(stride.step_length_m - (end - put(side.other, stride.opposite_contact_ns)))

    def _means(self, walk: JointWalk, valid: list[Stride]) -> None:
        measured = [stride for stride in valid if stride.walking_speed is not None]
        if not measured:
            return
        first, last = measured[0].start_ns / 1e9, measured[-1].end_ns / 1e9
        way = np.interp([first, last], walk.track.time_s, walk.body.pelvis.position[:, 0])
        self.speeds.append(
            float(np.mean([stride.walking_speed for stride in measured]) - (way[1] - way[0]) / (last - first))
        )
        contacts = np.sort(np.concatenate([walk.contacts_s(side) for side in Side]))
        steady = contacts[(contacts >= first - WITHIN_S) & (contacts <= last + WITHIN_S)]
        cadence = 60.0 / float(np.mean(np.diff(steady)))
        self.cadences.append(float(np.mean([120.0 / stride.stride_time_s for stride in measured])) - cadence)
        stances = [stride.stance_fraction for stride in valid if stride.stance_fraction is not None]
        self.stances.append(float(np.mean(stances)) - _true_stance(walk))


def _true_stance(walk: JointWalk) -> float:
    shares: list[float] = []
    for side in Side:
        contacts, toe_offs = walk.contacts_s(side), walk.toe_offs_s(side)
        for start, end in pairwise(contacts):
            shares += [(at - start) / (end - start) for at in toe_offs if start < at < end]
    return float(np.mean(shares))


def gait_rows(walks: int) -> list[Row]:
    """Given joint centres on both grounds, then the whole chain on the treadmill."""
    rows: list[Row] = []
    queries = [f"speed={SPEEDS[k % len(SPEEDS)]}&seed={FIRST_SEED + k}&duration=40" for k in range(walks)]
    for ground, treadmill in (("floor", False), ("treadmill", True)):
        given = Walks()
        for k, query in enumerate(queries):
            seen = seen_walk(query, treadmill=treadmill, noise_m=NOISE_M, offset_m=OFFSET_M, seed=FIRST_SEED + k)
            node = build(seen.description())
            outputs = [output for message in seen.messages() for output in node.step(message)] + node.finish()
            payloads = [output.payload for output in outputs]
            given.add(
                seen.walk,
                [one for one in payloads if isinstance(one, GaitEvent)],
                [one for one in payloads if isinstance(one, Stride)],
            )
        rows += _figures(f"joint centres as given, {ground}", given, detail=True)
    chained = Walks()
    for query in track(queries, "walks before a camera"):
        session = through_chain(f"synthetic:walk?camera=2&{query}")
        chained.add(joint_walk(query), session.events, session.strides)
    return [*_figures("whole chain, treadmill", chained), *rows]


def _figures(name: str, walks: Walks, *, detail: bool = False) -> list[Row]:
    contacts, toe_offs = 1e3 * np.array(walks.contacts), 1e3 * np.array(walks.toe_offs)
    told = 100.0 * walks.strides_valid / walks.strides_true
    rows = [
        at_least(f"{name}: events found", 100.0 * walks.found / walks.true, "%", 90.0, walks.true),
        at_least(f"{name}: events told that are true", 100.0 * walks.found / max(walks.told, 1), "%", 90.0, walks.told),
        informative(f"{name}: contact, bias", float(contacts.mean()), "ms"),
        at_most(f"{name}: contact, standard deviation", float(contacts.std()), "ms", 40.0),
        informative(f"{name}: toe-off, bias", float(toe_offs.mean()), "ms"),
        at_most(f"{name}: toe-off, standard deviation", float(toe_offs.std()), "ms", 40.0),
        informative(f"{name}: strides that count", told, "%", walks.strides_true),
        at_most(f"{name}: speed, mean absolute error", float(np.mean(np.abs(walks.speeds))), "m/s", 0.05),
        informative(f"{name}: speed, bias", float(np.mean(walks.speeds)), "m/s"),
        at_most(f"{name}: cadence, mean absolute error", float(np.mean(np.abs(walks.cadences))), "steps/min", 2.0),
        at_most(f"{name}: step length, mean absolute error", float(np.mean(np.abs(walks.steps))), "m", 0.05),
        at_most(f"{name}: stride length, mean absolute error", float(np.mean(np.abs(walks.strides))), "m", 0.06),
        at_most(f"{name}: stance, mean absolute error", 100 * float(np.mean(np.abs(walks.stances))), "% stride", 3.0),
    ]
    return [Row(r.name, r.value, r.unit, r.target, r.met, r.baseline, detail) for r in rows]
