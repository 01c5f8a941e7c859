"""Who is waited for, how far a session may run, and how messages grow when there is too much to do."""

import itertools

from services.ingest.batching import Batcher, BatchGovernor
from services.ingest.pacing import FAR_NS, AsFastAsFollowed, Readers, RealTime
from services.ingest.parameters import IngestParameters
from services.ingest.source import in_batches, open_source

SECOND = 1_000_000_000


def sent_readers(count=1000):
    readers = Readers(["imu/hub", "reference/reference"])
    for sequence in range(count):
        readers.sent("imu/hub", sequence, sequence * 10_000_000)
    return readers


def test_real_time_follows_the_clock():
    pace = RealTime(started_s=100.0, speed=2.0)
    assert pace.limit_ns(100.0) == 0
    assert pace.limit_ns(101.5) == 3 * SECOND


def test_an_unpaced_replay_stays_ten_seconds_ahead_of_the_slowest():
    readers = sent_readers()
    pace = AsFastAsFollowed(readers, started_s=0.0)
    assert pace.limit_ns(0.1) == 10 * SECOND
    readers.report("archive", {"imu/hub": 900}, 0.2)
    readers.report("estimation", {"imu/hub": 300, "calibration/estimation": 0}, 0.2)
    assert pace.limit_ns(0.3) == 13 * SECOND
    readers.report("estimation", {"imu/hub": 500}, 0.4)
    assert pace.limit_ns(0.5) == 15 * SECOND


def test_services_further_down_are_not_waited_for():
    readers = sent_readers()
    readers.report("metrics", {"stride/segmentation": -1}, 0.1)
    readers.report("archive", {"imu/hub": 500}, 0.1)
    assert readers.slowest_ns(0.2) == 5 * SECOND


def test_a_running_service_is_waited_for_before_its_first_word():
    readers = sent_readers()
    readers.expect("estimation", 0.0)
    readers.report("archive", {"imu/hub": 900}, 0.1)
    assert readers.slowest_ns(1.0) == 0


def test_a_reader_that_stands_still_is_left_behind():
    readers = sent_readers()
    readers.report("estimation", {"imu/hub": 100}, 0.0)
    readers.report("archive", {"imu/hub": 900}, 0.0)
    for now_s in range(100):
        readers.report("estimation", {"imu/hub": 100}, now_s)
    readers.report("archive", {"imu/hub": 950}, 100.0)
    assert readers.slowest_ns(100.0) == 9_500_000_000


def test_without_readers_it_waits_a_little_and_goes_on():
    pace = AsFastAsFollowed(Readers(["imu/hub"]), started_s=0.0)
    assert pace.limit_ns(4.9) == 10 * SECOND
    assert pace.limit_ns(5.1) == FAR_NS


def test_a_reader_may_speak_before_anything_was_sent():
    readers = Readers(["imu/hub"])
    readers.report("estimation", {"imu/hub": -1}, 0.1)
    assert readers.slowest_ns(0.2) == 0


def test_what_everybody_has_is_forgotten():
    readers = sent_readers()
    readers.report("archive", {"imu/hub": 600}, 0.0)
    readers.forget()
    readers.report("archive", {"imu/hub": 700}, 1.0)
    assert readers.slowest_ns(1.0) == 7 * SECOND


def test_memory_is_bounded_without_readers():
    readers = sent_readers(100_000)
    assert sum(len(sequences) for sequences, _ in readers._sent.values()) <= 40_000


def test_messages_grow_under_lag_and_shrink_afterwards():
    governor = BatchGovernor(IngestParameters())
    ticks = [governor.observe(k * 0.1, 0.5) for k in range(80)]
    assert ticks[0] == 1
    assert ticks[-1] == 5
    assert all(0 <= after - before <= 1 for before, after in itertools.pairwise(ticks))
    assert [governor.observe(8 + k * 0.1, 0.05) for k in range(300)][-1] == 5
    assert [governor.observe(38 + k, 0.0) for k in range(300)][-1] == 1


def test_messages_that_shrank_too_early_wait_twice_as_long():
    governor, s, shrunk_s = BatchGovernor(IngestParameters()), 0.0, []
    for _ in range(6000):
        before = governor.ticks
        # Three ticks are needed to keep up.
        ticks = governor.observe(s, 0.5 if before < 3 else 0.0)
        shrunk_s += [s] if ticks < before else []
        s += 0.5
    waits = [after - before for before, after in itertools.pairwise(shrunk_s)]
    assert all(later > 1.8 * earlier for earlier, later in itertools.pairwise(waits[:4]))
    assert max(waits) < 1000.0


def test_batches_may_change_size_and_lose_nothing():
    source = open_source("synthetic:walk?duration=5")
    single = list(source.messages())
    batcher, joined = Batcher(), []
    for index, message in enumerate(source.messages()):
        batcher.ticks = 1 + index // 100 % 5
        joined += batcher.add(message)
    joined += batcher.flush()
    assert samples(joined) == samples(single)
    assert len(joined) < len(single)
    assert list(in_batches(source.messages(), 1)) == single


def samples(messages):
    return [
        (time, rate, force)
        for message in messages
        if message.stream.name == "imu/walker"
        for sensor in message.payload.sensors
        for time, rate, force in zip(sensor.captured_ns, sensor.angular_velocity, sensor.specific_force, strict=True)
        if sensor is message.payload.sensors[0]
    ]


def test_messages_that_grow_stay_short_in_time_whatever_the_rate():
    source = open_source("synthetic:walk?camera=1&duration=8&seed=2")
    batcher = Batcher(ticks=5, longest_ns=50_000_000)
    spans: dict[str, set[int]] = {}
    for message in source.messages():
        for batch in batcher.add(message):
            frames = getattr(batch.payload, "captured_ns", None)
            if frames is None:
                frames = batch.payload.sensors[0].captured_ns
            spans.setdefault(batch.stream.signal.name, set()).add(len(frames))
    assert spans["imu"] == {5}
    # Two frames that follow each other, 33 ms apart; three never, not even around a lost one.
    assert max(spans["skeleton"]) == 2
