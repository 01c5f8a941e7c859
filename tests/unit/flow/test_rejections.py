"""Counting by subject and reason."""

from schemas.health import Reason, Rejection
from services.flow.rejections import RejectionCounter


def test_counts_by_subject_and_reason():
    counter = RejectionCounter()
    counter.add("b", Reason.STUCK)
    counter.add("a", Reason.NOT_FINITE, 3)
    counter.add("b", Reason.STUCK)
    assert counter.report() == [
        Rejection(subject="a", reason=Reason.NOT_FINITE, count=3),
        Rejection(subject="b", reason=Reason.STUCK, count=2),
    ]
