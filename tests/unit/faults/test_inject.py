import pytest

from schemas.imu import ImuBatch, SensorSamples
from schemas.signals import IMU
from services.faults.faults import ClockStep, Duplicated, HubGap, Reordered, SensorOff, SensorStuck, Spike
from services.faults.inject import disturb, inject
from services.flow.message import Envelope, Message, Stream

SENSORS = ["pelvis", "shank"]


def stream(n: int = 100) -> list[Message]:
    def samples(i: int) -> SensorSamples:
        return SensorSamples(
            captured_ns=[i * 10_000_000], angular_velocity=[[0.1 * i, 0, 0]], specific_force=[[0, 9.81, 0]]
        )

    body = [
        Message(Stream(IMU, "hub"), Envelope(0, i, i * 10_000_000), ImuBatch(sensors=[samples(i), samples(i)]))
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
