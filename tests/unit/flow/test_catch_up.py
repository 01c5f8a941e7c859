"""The past of several streams, whichever ring answers first."""

import random

from schemas.signals import IMU, SKELETON
from services.flow.catch_up import CatchUp
from services.flow.message import Stream

HUB, CAMERA = Stream(IMU, "hub"), Stream(SKELETON, "camera")
Item = tuple[str, int]


def catch_up() -> CatchUp[Item]:
    return CatchUp((HUB, CAMERA), lambda item: item[1])


def test_the_second_ring_is_waited_for_and_all_comes_in_captured_order():
    waiting = catch_up()
    for t in range(0, 100, 10):
        waiting.add(HUB, ("hub", t))
    assert waiting.ready([HUB]) == []
    for t in range(5, 100, 33):
        waiting.add(CAMERA, ("camera", t))
    out = waiting.ready([HUB]) + waiting.ready([HUB, CAMERA])
    assert [t for _, t in out] == sorted(t for _, t in out)
    assert len(out) == 13
    assert waiting.is_over([HUB, CAMERA])


def test_a_stream_without_a_past_is_not_waited_for_once_it_said_so():
    waiting = catch_up()
    waiting.add(HUB, ("hub", 1))
    assert not waiting.is_over([HUB])
    assert waiting.ready([CAMERA]) == [("hub", 1)]
    assert not waiting.is_over([CAMERA])
    assert waiting.is_over([HUB, CAMERA])


def test_equal_times_come_in_the_order_of_the_streams():
    waiting = catch_up()
    waiting.add(CAMERA, ("camera", 7))
    waiting.add(HUB, ("hub", 7))
    assert waiting.ready([HUB, CAMERA]) == [("hub", 7), ("camera", 7)]


def test_any_interleaving_of_the_answers_gives_the_same_order():
    hub = [("hub", 10 * k) for k in range(30)]
    camera = [("camera", 33 * k) for k in range(9)]
    expected = sorted(hub + camera, key=lambda item: (item[1], item[0] != "hub"))
    for seed in range(20):
        dice, waiting, out = random.Random(seed), catch_up(), []
        left = {HUB: list(hub), CAMERA: list(camera)}
        while any(left.values()):
            stream = dice.choice([each for each, items in left.items() if items])
            for _ in range(dice.randint(1, 12)):
                if left[stream]:
                    waiting.add(stream, left[stream].pop(0))
            out += waiting.ready([each for each, items in left.items() if not items])
        assert out == expected
