"""Rows about the distance of learned strides: sides, people, there and back."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import degrees

import numpy as np

from schemas.kinematics import JointState
from schemas.rhythm import KnownRhythm, Rhythm
from schemas.vocabulary import LOWER_BODY
from services.bench.rhythm.motions import INTERVAL_S
from services.bench.rhythm.short_walks import draw_person, short_walk
from services.bench.rhythm.stride_shapes import RECORDING, StrideShapes
from services.bench.scoreboard import Row, at_least, at_most, informative
from services.biomech.rhythm.comparison import Comparison, Leg, compare_legs
from services.biomech.rhythm.learned import Learned, LearnedStrides
from services.biomech.rhythm.reading import RhythmReading
from services.biomech.rhythm.trusted import TrustedRhythm
from services.estimation.learning import described
from services.estimation.node import build
from services.estimation.rows import RHYTHM_CHANNELS
from services.flow.chain import Chain
from services.flow.host import HostedNode
from services.ingest.source import iter_messages, open_source

ASYMMETRIES = (0.0, 0.1, 0.2, 0.3, 0.4)
LEARNING_S = 25.0
THERE_S, BACK_S = (0.0, 15.8), (16.6, np.inf)
"""Of the recorded walk: its first whole stride (the one after it only confirms it), and the way back."""
STRANGER = 100_000
LEFT, RIGHT = ([i for i, name in enumerate(RHYTHM_CHANNELS) if name.endswith(side)] for side in ("left", "right"))
SIDES = {"left": LEFT, "right": RIGHT}

Follow = Callable[[str, Callable[[int], float], Sequence[int]], list[float]]


def learn_recording(spec: str, *spans_s: tuple[float, float], known: Sequence[KnownRhythm] = ()) -> list[Learned]:
    """What is learned of a source between these times (s), through ingest and estimation, span by span."""
    source = open_source(spec, session="distance", known_rhythms=known)
    description = source.describe()
    chain = Chain([HostedNode("estimation", description.session, build(description))])
    joints = [[dof.name for dof in LOWER_BODY].index(name) for name in RHYTHM_CHANNELS]
    learned = [LearnedStrides(len(joints)) for _ in spans_s]
    velocity: dict[int, list[float]] = {}
    last_ns = 0
    for message in iter_messages(source):
        for produced in chain.push(message):
            match produced.payload:
                case JointState() as state:
                    velocity = dict(zip(state.captured_ns, state.velocity, strict=True))
                case Rhythm() as rhythm:
                    for at_ns, reading in zip(rhythm.captured_ns, _readings(rhythm), strict=True):
                        for strides, (start_s, end_s) in zip(learned, spans_s, strict=True):
                            if start_s <= at_ns / 1e9 < end_s:
                                strides.take([velocity[at_ns][j] for j in joints], reading, (at_ns - last_ns) / 1e9)
                        last_ns = at_ns
    return [strides.result() for strides in learned]


def _readings(rhythm: Rhythm) -> list[RhythmReading]:
    rows = zip(rhythm.phase, rhythm.frequency, rhythm.quality, rhythm.locked, strict=True)
    return [RhythmReading(*row, jerk=np.zeros(0)) for row in rows]


def leg(learned: Learned, joints: list[int]) -> Leg:
    """The joints of one leg, knee first."""
    return Leg(learned.cosine[joints], learned.sine[joints], learned.spread[joints], learned.strides)


def between_sides(learned: Learned) -> Comparison:
    """Left against right."""
    return compare_legs(leg(learned, LEFT), leg(learned, RIGHT))


def side_distance(asymmetry_percent: int) -> float:
    """rad, of a synthetic walker with one leg's movement smaller and earlier."""
    [learned] = learn_recording(f"synthetic:walk?speed=1.1&seed=1005&duration=30&asymmetry={asymmetry_percent / 100}",
                                (0.0, np.inf))  # fmt: skip
    return between_sides(learned).distance


def side_rows(follow: Follow) -> list[Row]:
    """Whether the distance grows with the asymmetry."""
    found = follow("distance of sides", side_distance, [round(100 * asymmetry) for asymmetry in ASYMMETRIES])
    least_growth = min(after - before for before, after in pairwise(found))
    return [
        at_least("distance: least growth from 0.1 to 0.1 of asymmetry", degrees(least_growth), "deg", 0.1),
        at_most("distance: sides of a symmetric walker", degrees(found[0]), "deg", 0.5),
        informative("distance: sides at asymmetry 0.4", degrees(found[-1]), "deg"),
    ]


def person_ratio(seed: int, shapes: StrideShapes) -> float:
    """Shape distance of a leg from the same person's next trial, over that from a stranger."""
    person, stranger = draw_person(seed, shapes), draw_person(seed + STRANGER, shapes)
    first, second = _learn_trial(person.seed, shapes, 0), _learn_trial(person.seed, shapes, 1)
    other = _learn_trial(stranger.seed, shapes, 0)
    # Knee and thigh pitch of the left leg are channels 0 and 2 of these motions.
    own, strange = (compare_legs(leg(first, [0, 2]), leg(learned, [0, 2])) for learned in (second, other))
    return own.shape / strange.shape


def _learn_trial(seed: int, shapes: StrideShapes, trial: int) -> Learned:
    walk = short_walk(draw_person(seed, shapes), trial, LEARNING_S)
    rhythm, learned = TrustedRhythm(walk.measured.shape[1]), LearnedStrides(walk.measured.shape[1])
    for velocity in walk.measured:
        learned.take(velocity.tolist(), rhythm.step(velocity, INTERVAL_S), INTERVAL_S)
    return learned.result()


def person_rows(ratios: Sequence[float]) -> list[Row]:
    """Same person against a stranger, over many people."""
    return [
        at_most("distance of shape: same person / stranger, median", float(np.median(ratios)), "1", 0.3),
        at_most("distance of shape: same person / stranger, largest", max(ratios), "1", 1.0),
    ]


def recorded_rows() -> list[Row]:
    """The recorded walk: left and right, there and back. Nothing is known of its truth, so nothing is judged.

    Too short for a cold start: what is learned in a first pass starts the second. One stride each way has no scatter.

    Raises:
        MissingFile: the recording is not on this machine.
    """
    always = (0.0, np.inf)
    [first] = learn_recording(RECORDING, always)
    known = KnownRhythm(name="first pass", kind="previous trial", rhythm=described(first, [True] * 4, 0))
    whole, there, back = learn_recording(RECORDING, always, THERE_S, BACK_S, known=[known])
    sides = between_sides(whole)
    rows = [
        informative("recorded walk: strides there, and back as baseline", there.strides, "strides", back.strides),
        informative("recorded walk: left and right", degrees(sides.distance), "deg"),
        informative("recorded walk: left and right, by chance", degrees(sides.chance), "deg"),
        informative("recorded walk: left and right, shape", sides.shape, "1"),
        informative("recorded walk: right leg late by", 100 * (sides.shift % (2 * np.pi) - np.pi) / (2 * np.pi),
                    "% of stride"),
    ]  # fmt: skip
    for side, joints in SIDES.items():
        result = compare_legs(leg(there, joints), leg(back, joints))
        rows.append(informative(f"recorded walk: there and back, {side}", degrees(result.distance), "deg"))
    return rows
