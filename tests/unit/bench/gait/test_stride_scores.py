import numpy as np
import pytest

from schemas.gait import GaitEvent
from schemas.imu import ReferenceBatch
from schemas.session import ReferenceChannel
from schemas.vocabulary import GaitEventKind, Side
from services.bench.gait.joint_walks import joint_walk
from services.bench.gait.stride_scores import Found, Truth, length_errors, match, together

IC, TO = GaitEventKind.INITIAL_CONTACT, GaitEventKind.TOE_OFF


def truth(**channels: list[float | None]) -> Truth:
    listed = [ReferenceChannel(name=name, unit="m") for name in channels]
    description = joint_walk("duration=20").description.model_copy(update={"reference": listed})
    made = Truth(description)
    rows = [list(row) for row in zip(*channels.values(), strict=True)]
    made.take(ReferenceBatch(captured_ns=[k * 10_000_000 for k in range(len(rows))], values=rows))
    return made


def test_nearest_pairs_first_and_each_event_once():
    matched = match(np.array([1.0, 2.0, 3.0]), np.array([1.1, 1.9, 2.05, 5.0]))
    assert sorted(matched.errors_s.round(6).tolist()) == [0.05, 0.1]
    assert (matched.missed, matched.extra) == (1, 2)
    assert matched.bias_ms == pytest.approx(75.0)


def test_nothing_to_pair():
    empty = match(np.array([1.0]), np.array([]))
    assert (empty.missed, empty.extra, empty.bias_ms, empty.spread_ms) == (1, 0, None, None)
    assert together([empty, match(np.array([1.0]), np.array([1.2]))]).missed == 1


def test_edges_of_the_contact_channel():
    made = truth(foot_contact_left=[1, 1, 0, 0, 1, None, 1, 0])
    np.testing.assert_allclose(made.contact_edges_s(Side.LEFT, IC), [0.04])
    np.testing.assert_allclose(made.contact_edges_s(Side.LEFT, TO), [0.02, 0.07])
    with pytest.raises(KeyError):
        made.channel("foot_contact_right")


def test_distance_over_ground():
    steps = [0.1 * k for k in range(6)]
    made = truth(ankle_left_x=steps, ankle_left_y=[9.0] * 6, ankle_left_z=[2 * s for s in steps])
    assert made.distance(Side.LEFT, 10_000_000, 30_000_000) == pytest.approx(0.2 * np.sqrt(5))


def test_optical_events_of_a_swinging_ankle():
    at = np.arange(1000) / 100
    channels = {f"{name}_{axis}": [0.0] * 1000 for name in ("hip_left", "hip_right", "ankle_left") for axis in "xyz"}
    channels["hip_right_z"] = [0.2] * 1000
    channels["ankle_left_x"] = (0.4 * np.cos(2 * np.pi * at)).tolist()
    made = truth(**channels)
    np.testing.assert_allclose(made.ankle_turns_s(Side.LEFT, IC), np.arange(1, 10) + 0.04, atol=1e-9)
    np.testing.assert_allclose(made.ankle_turns_s(Side.LEFT, TO), np.arange(10) + 0.5 + 0.037, atol=1e-9)


def test_only_strides_with_a_length_are_compared():
    event = GaitEvent(kind=IC, side=Side.LEFT, captured_ns=5, time_std_s=0.02)
    found = Found(events=[event])
    np.testing.assert_allclose(found.times_s(Side.LEFT, IC), [5e-9])
    length, speed = length_errors(found, truth(ankle_left_x=[0.0]))
    assert len(length) == len(speed) == 0


def test_the_claimed_deviation_is_a_mean_over_both_feet():
    found = Found(
        [
            GaitEvent(kind=IC, side=side, captured_ns=1, time_std_s=std)
            for side, std in ((Side.LEFT, 0.02), (Side.RIGHT, 0.05))
        ]
    )
    assert (found.claimed_ms(IC), found.claimed_ms(TO)) == (35.0, None)
