import pytest

from schemas.imu import ImuBatch, SensorSamples
from schemas.signals import IMU, REFERENCE
from services.faults.disturb import disturb
from services.faults.faults import (
    ClockStep,
    Duplicated,
    HubGap,
    Reordered,
    SensorOff,
    SensorStuck,
    Spike,
    radio_loss,
)
from services.faults.inject import Injection, inject
from services.flow.message import Envelope, Message, Stream

SENSORS = ["pelvis", "shank"]


def stream(n: int = 100) -> list[Message]:
    def samples(i: int) -> SensorSamples:
        return SensorSamples(
            captured_ns=[i * 10_000_000], angular_velocity=[[0.1 * i, 0, 0]], specific_force=[[0, 9.81, 0]]
        )

    body = [
        Message(
            Stream(IMU, "hub"), Envelope(0, i, i * 10_000_000), ImuBatch(sensors=[samples(i), samples(i)], marks=[])
        )
        for i in range(n)
    ]
    return [*body, Message(Stream(IMU, "hub"), Envelope(0, n, n * 10_000_000, final=True), None)]


def of(messages, sensor):
    return [m.payload.sensors[SENSORS.index(sensor)] for m in messages if m.payload]


def test_no_fault_changes_nothing():
    assert list(inject(stream(), SENSORS, [])) == stream()


def test_a_sensor_that_is_off_leaves_the_other_alone():
    damaged = list(inject(stream(), SENSORS, [SensorOff("shank", 0.2, 0.5)]))
    assert [i for i, s in enumerate(of(damaged, "shank")) if not s.captured_ns] == list(range(20, 50))
    assert of(damaged, "pelvis") == of(stream(), "pelvis")


def test_a_stuck_sensor_repeats_values_with_fresh_times():
    shank = of(list(inject(stream(), SENSORS, [SensorStuck("shank", 0.2, 0.5)])), "shank")
    assert {tuple(s.angular_velocity[0]) for s in shank[20:50]} == {tuple(shank[19].angular_velocity[0])}
    assert [s.captured_ns[0] for s in shank] == [i * 10_000_000 for i in range(100)]


def test_a_spike_is_one_sample():
    shank = of(list(inject(stream(), SENSORS, [Spike("shank", 0.3, 30.0, 200.0)])), "shank")
    assert [i for i, s in enumerate(shank) if s.specific_force[0][1] > 100] == [30]


def test_a_silent_receiver_leaves_no_hole_in_the_numbering():
    damaged = list(inject(stream(), SENSORS, [HubGap(0.3, 0.6)]))
    assert [m.envelope.sequence for m in damaged] == list(range(71))
    assert damaged[30].envelope.captured_ns - damaged[29].envelope.captured_ns == 310_000_000
    assert damaged[-1].envelope.final


def test_a_clock_step_stays():
    shank = of(list(inject(stream(), SENSORS, [ClockStep("shank", 0.5, -0.2)])), "shank")
    assert shank[50].captured_ns[0] == 300_000_000
    assert shank[99].captured_ns[0] == 790_000_000


@pytest.mark.parametrize("seed", range(5))
def test_a_bad_network_loses_nothing_by_itself(seed):
    delivered = disturb(stream(), [Duplicated(0.2), Reordered(8)], seed)
    assert {m.envelope.sequence for m in delivered} == set(range(101))
    assert len(delivered) > 101
    assert [m.envelope.sequence for m in delivered] != sorted(m.envelope.sequence for m in delivered)
    assert delivered == disturb(stream(), [Duplicated(0.2), Reordered(8)], seed)


def times(messages, sensor) -> list[int]:
    return [ns for samples in of(messages, sensor) for ns in samples.captured_ns]


def in_batches_of(count: int) -> list[Message]:
    """The same stream, `count` ticks in a message."""
    single = stream()[:-1]
    joined = []
    for i, start in enumerate(range(0, 100, count)):
        parts = [message.payload.sensors for message in single[start : start + count]]
        samples = [
            SensorSamples(
                captured_ns=[ns for part in parts for ns in part[s].captured_ns],
                angular_velocity=[row for part in parts for row in part[s].angular_velocity],
                specific_force=[row for part in parts for row in part[s].specific_force],
            )
            for s in range(2)
        ]
        joined.append(
            Message(Stream(IMU, "hub"), Envelope(0, i, samples[0].captured_ns[-1]), ImuBatch(sensors=samples, marks=[]))
        )
    return joined


LOSSES = [SensorOff("pelvis", 0.2, 0.3), HubGap(0.6, 0.65), *radio_loss(SENSORS, 0.2, 4)]


def test_every_sample_is_delivered_or_listed_as_lost():
    injection = Injection(SENSORS, LOSSES)
    damaged = list(injection.apply(stream()))
    assert injection.sent == {"pelvis": 100, "shank": 100}
    for sensor in SENSORS:
        assert injection.lost[sensor]
        assert sorted([*times(damaged, sensor), *injection.lost[sensor]]) == times(stream(), sensor)


@pytest.mark.parametrize("count", [2, 5, 7])
def test_batches_make_no_difference(count):
    faults = [*LOSSES, Spike("shank", 0.3, 30.0, 200.0), SensorStuck("shank", 0.7, 0.8)]
    one, many = Injection(SENSORS, faults), Injection(SENSORS, faults)
    single, joined = list(one.apply(stream())), list(many.apply(in_batches_of(count)))
    assert one.lost == many.lost
    for sensor in SENSORS:
        assert times(single, sensor) == times(joined, sensor)
        rates = [[row for s in of(m, sensor) for row in s.angular_velocity] for m in (single, joined)]
        assert rates[0] == rates[1]


def test_a_receiver_misses_all_sensors_at_once_and_each_radio_its_own():
    common, *_ = radio_loss(SENSORS, 0.3, 1)
    injection = Injection(SENSORS, [common])
    list(injection.apply(stream()))
    assert injection.lost["pelvis"] == injection.lost["shank"] != set()
    injection = Injection(SENSORS, radio_loss(SENSORS, 0.3, 1))
    list(injection.apply(stream()))
    pelvis, shank = (injection.lost[sensor] for sensor in SENSORS)
    assert pelvis & shank
    assert pelvis - shank
    assert shank - pelvis


def test_other_streams_keep_their_numbers():
    beside = Message(Stream(REFERENCE, "reference"), Envelope(0, 7, 500_000_000, final=True), None)
    damaged = list(inject([*stream(), beside], SENSORS, [HubGap(0.3, 0.6)]))
    assert damaged[-1] == beside
