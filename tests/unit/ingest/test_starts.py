"""Starting once, whatever is asked how often and by how many at a time."""

import threading
from concurrent.futures import ThreadPoolExecutor

import pytest

from services.ingest import starts
from services.ingest.errors import SourceError
from services.ingest.orders import InvalidOrder, StartOrder
from services.ingest.starts import Starts


def order(session="s", source="x"):
    return StartOrder(source=source, speed=1.0, session=session)


def test_orders_at_the_same_time_are_carried_out_once():
    made, go, answers = [], threading.Event(), Starts()

    def start():
        made.append(1)
        go.wait(10.0)
        return object()

    with ThreadPoolExecutor(4) as pool:
        asked = [pool.submit(answers.once, order(), start) for _ in range(4)]
        while not made:
            pass
        go.set()
        assert len({id(each.result(10.0)) for each in asked}) == 1
    assert len(made) == 1


def test_a_start_that_failed_may_be_ordered_again():
    answers = Starts()

    def fail():
        raise SourceError("not there")

    with pytest.raises(SourceError, match="not there"):
        answers.once(order(), fail)
    assert answers.once(order(), lambda: "now") == "now"


def test_another_order_of_the_same_session_is_refused():
    answers = Starts()
    answers.once(order(), lambda: "first")
    with pytest.raises(InvalidOrder, match="another id"):
        answers.once(order(source="y"), lambda: "second")


def test_without_an_id_every_order_is_a_new_one():
    answers, made = Starts(), iter("ab")
    assert [answers.once(order(session=None), lambda: next(made)) for _ in range(2)] == ["a", "b"]


def test_only_so_many_are_remembered(monkeypatch):
    monkeypatch.setattr(starts, "MOST_REMEMBERED", 2)
    answers = Starts()
    for session in "abc":
        answers.once(order(session), lambda: "first")
    assert answers.once(order("a"), lambda: "again") == "again"
    assert answers.once(order("c"), lambda: "again") == "first"
