import json

import numpy as np
import pytest

from schemas.session import Anthropometry
from schemas.vocabulary import GaitEventKind, Side
from services.segmentation.batch import DOFS, Batch
from services.segmentation.gait import strides as reasons
from services.segmentation.gait.history import HEADING, History
from services.segmentation.gait.strides import Flaw, StrideAssembler
from services.segmentation.gait.swing import Contact
from services.segmentation.parameters import SegmentationParameters

BODY = Anthropometry(
    height_m=None, mass_kg=None, thigh_length_m=0.4, shank_length_m=0.4, hip_width_m=0.2, source="measured"
)
PARAMETERS = SegmentationParameters()
SECOND = 1_000_000_000


def assembler(turns_per_s: float | None = 1.0, heading_rate: float = 0.0, seconds: int = 10) -> StrideAssembler:
    """Ten seconds of standing posture with the rhythm running."""
    history = History()
    steps = np.arange(seconds * 100)
    position = np.zeros((len(steps), DOFS))
    position[:, HEADING] = heading_rate * steps / 100
    phase = np.full(len(steps), np.nan) if turns_per_s is None else 2 * np.pi * turns_per_s * steps / 100
    batch = Batch(
        steps * 10_000_000,
        position,
        np.zeros_like(position),
        phase,
        np.zeros_like(position),
        np.ones(DOFS, dtype=bool),
        frozenset(),
    )
    for row in range(len(steps)):
        history.append(batch, row)
    return StrideAssembler(PARAMETERS, BODY, history)


def contact(assembled: StrideAssembler, side: Side, at_s: float) -> None:
    assembled.add_event(side, Contact(GaitEventKind.INITIAL_CONTACT, round(at_s * SECOND), 0.02))


def toe_off(assembled: StrideAssembler, side: Side, at_s: float) -> None:
    assembled.add_event(side, Contact(GaitEventKind.TOE_OFF, round(at_s * SECOND), 0.02))


def test_a_stride_in_full():
    assembled = assembler()
    contact(assembled, Side.LEFT, 2.0)
    contact(assembled, Side.RIGHT, 2.5)
    toe_off(assembled, Side.LEFT, 2.6)
    contact(assembled, Side.LEFT, 3.0)
    assert assembled.release(3 * SECOND) == []
    [stride] = assembled.release(4 * SECOND)
    assert (stride.side, stride.index, stride.valid, stride.turning) == (Side.LEFT, 0, True, False)
    assert (stride.start_ns, stride.end_ns) == (2 * SECOND, 3 * SECOND)
    assert stride.stride_time_s == pytest.approx(1.0)
    assert stride.stance_fraction == pytest.approx(0.6)
    assert stride.step_time_s == pytest.approx(0.5)
    assert stride.phase_advance == pytest.approx(2 * np.pi)
    assert stride.step_length_m == pytest.approx(0.0)
    assert stride.walking_speed == pytest.approx(0.0)
    assert len(stride.curves) == DOFS


@pytest.mark.parametrize(
    ("lifted", "told"),
    [([2.1], 2.1), ([], None), ([1.9, 2.1], 2.1), ([1.9, 2.95], None), ([2.1, 2.95], 2.1)],
    ids=["in first double support", "not seen", "also before", "before and late", "and again"],
)
def test_the_other_foot_leaves_the_ground_before_it_comes_down(lifted, told):
    assembled = assembler()
    for at in lifted:
        toe_off(assembled, Side.RIGHT, at)
    for at, side in ((2.0, Side.LEFT), (2.5, Side.RIGHT), (3.0, Side.LEFT)):
        contact(assembled, side, at)
    [stride] = assembled.release(None)
    assert stride.opposite_toe_off_ns == (None if told is None else round(told * SECOND))


def test_without_the_other_contact_no_other_toe_off():
    assembled = assembler()
    toe_off(assembled, Side.RIGHT, 2.1)
    contact(assembled, Side.LEFT, 2.0)
    contact(assembled, Side.LEFT, 3.0)
    [stride] = assembled.release(None)
    assert stride.opposite_toe_off_ns is stride.circumduction_m is None


def test_a_width_only_where_it_is_measured():
    asked = []

    def width(leading: Side, contact_ns: int, trailing_ns: int) -> float:
        asked.append((leading, contact_ns, trailing_ns))
        return 0.12

    plain = assembler()
    measured = StrideAssembler(PARAMETERS, BODY, plain.history, measure_width=width)
    for assembled in (plain, measured):
        for at, side in ((2.0, Side.LEFT), (2.5, Side.RIGHT), (3.0, Side.LEFT)):
            contact(assembled, side, at)
    assert [stride.step_width_m for stride in plain.release(None)] == [None]
    assert [stride.step_width_m for stride in measured.release(None)] == [0.12]
    assert asked == [(Side.LEFT, 3 * SECOND, round(2.5 * SECOND))]


def test_without_a_lock_the_rhythm_has_no_say():
    assembled = assembler(turns_per_s=None)
    for at, side in ((2.0, Side.LEFT), (2.5, Side.RIGHT), (3.0, Side.LEFT)):
        contact(assembled, side, at)
    [stride] = assembled.release(None)
    assert stride.valid
    assert stride.phase_advance is None
    assert stride.toe_off_ns is stride.stance_fraction is None


@pytest.mark.parametrize(("turns", "reason"), [(2.0, reasons.PHASE_LONG), (0.5, reasons.PHASE_SHORT), (1.1, None)])
def test_the_rhythm_objects_to_doubles_and_halves(turns, reason):
    assembled = assembler(turns_per_s=turns)
    for at, side in ((2.0, Side.LEFT), (2.5, Side.RIGHT), (3.0, Side.LEFT)):
        contact(assembled, side, at)
    [stride] = assembled.release(None)
    assert (stride.valid, stride.rejected_because) == (reason is None, reason)


@pytest.mark.parametrize(
    ("others", "reason"),
    [
        ([], reasons.NO_OTHER_CONTACT),
        ([2.3, 2.7], reasons.MANY_OTHER_CONTACTS),
        ([2.05], reasons.NOT_ALTERNATING),
        ([2.95], reasons.NOT_ALTERNATING),
        ([2.35], None),
    ],
)
def test_the_feet_must_alternate(others, reason):
    assembled = assembler()
    contact(assembled, Side.LEFT, 2.0)
    for at in others:
        contact(assembled, Side.RIGHT, at)
    contact(assembled, Side.LEFT, 3.0)
    stride = next(s for s in assembled.release(None) if s.side is Side.LEFT)
    assert stride.rejected_because == reason


def test_a_late_contact_of_the_other_foot_is_not_missed():
    assembled = assembler()
    contact(assembled, Side.LEFT, 2.0)
    contact(assembled, Side.LEFT, 3.0)
    assembled.release(round(3.2 * SECOND))
    contact(assembled, Side.RIGHT, 2.7)
    [stride] = assembled.release(4 * SECOND)
    assert stride.opposite_contact_ns == round(2.7 * SECOND)


def test_a_leg_that_is_not_seen_does_not_spoil_the_other():
    assembled = assembler()
    assembled.add_flaw(Side.RIGHT, Flaw(0, None, reasons.SENSOR_MISSING))
    contact(assembled, Side.LEFT, 2.0)
    contact(assembled, Side.LEFT, 3.0)
    [stride] = assembled.release(None)
    assert stride.valid
    assert stride.step_time_s is stride.step_length_m is None


@pytest.mark.parametrize("flaw", [Flaw(2 * SECOND + 1, 2 * SECOND + 2, reasons.GAP), Flaw(SECOND, None, reasons.GAP)])
def test_a_stride_over_a_hole_does_not_count(flaw):
    assembled = assembler()
    assembled.add_flaw(Side.LEFT, flaw)
    for at, side in ((2.0, Side.LEFT), (2.5, Side.RIGHT), (3.0, Side.LEFT)):
        contact(assembled, side, at)
    [stride] = assembled.release(None)
    assert (stride.valid, stride.rejected_because) == (False, reasons.GAP)


def test_too_long_is_no_stride_and_too_short_does_not_count():
    assembled = assembler()
    contact(assembled, Side.LEFT, 1.0)
    contact(assembled, Side.LEFT, 5.5)
    contact(assembled, Side.LEFT, 5.8)
    [stride] = assembled.release(None)
    assert stride.rejected_because == reasons.TOO_SHORT


def test_standing_ends_a_bout():
    assembled = assembler()
    contact(assembled, Side.LEFT, 2.0)
    assembled.end_bout()
    contact(assembled, Side.LEFT, 4.0)
    assert assembled.release(None) == []
    contact(assembled, Side.RIGHT, 4.5)
    contact(assembled, Side.LEFT, 5.0)
    assert [stride.start_ns for stride in assembled.release(None)] == [4 * SECOND]


def test_turning():
    assembled = assembler(heading_rate=0.5)
    for at, side in ((2.0, Side.LEFT), (2.5, Side.RIGHT), (3.0, Side.LEFT)):
        contact(assembled, side, at)
    assert assembled.release(None)[0].turning


def test_strides_come_in_order_of_their_end():
    assembled = assembler()
    for at, side in ((2.5, Side.RIGHT), (2.0, Side.LEFT), (3.5, Side.RIGHT), (3.0, Side.LEFT), (4.0, Side.LEFT)):
        contact(assembled, side, at)
    ends = [stride.end_ns for stride in assembled.release(None)]
    assert ends == sorted(ends)
    assert len(ends) == 3


def test_snapshot_restores_waiting_strides():
    assembled = assembler()
    assembled.add_flaw(Side.RIGHT, Flaw(0, SECOND, reasons.GAP))
    for at, side in ((2.0, Side.LEFT), (2.5, Side.RIGHT), (3.0, Side.LEFT)):
        contact(assembled, side, at)
    resumed = assembler()
    resumed.restore(json.loads(json.dumps(assembled.snapshot())))
    assert resumed.snapshot() == assembled.snapshot()
    assert resumed.release(None) == assembled.release(None)


def test_memory_is_bounded():
    assembled = assembler()
    for number in range(40):
        contact(assembled, Side.LEFT, 0.1 * number)
        assembled.add_flaw(Side.RIGHT, Flaw(number, number + 1, reasons.GAP))
    assembled.end_bout()
    assembled.release(60 * SECOND)
    assembled.forget(60 * SECOND)
    assert assembled.legs[Side.LEFT].contacts == []
    assert assembled.legs[Side.RIGHT].flaws == []
