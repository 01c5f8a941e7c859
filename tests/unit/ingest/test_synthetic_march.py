"""The synthetic march keeps the beat, lifts its thighs, and its sensors tell of exactly that."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from schemas.vocabulary import Side
from services.ingest.errors import InvalidOption, UnknownSource
from services.ingest.source import iter_messages, open_source
from services.ingest.synthetic import MarchParameters, SyntheticMarch, write_recording
from services.ingest.synthetic.march import PUBLISHED_BEATS_PER_MIN

PERFECT = MarchParameters(
    duration=20.0, rate=500.0, gyro_noise=0.0, accel_noise=0.0, gyro_bias=0.0, accel_bias=0.0, metronome=70.0, seed=3
)


def integrated(rate, interval_s):
    """R_start_from_sensor at the last of the samples: mean rates of neighbours, turned one after another."""
    turned = Rotation.identity()
    for step in Rotation.from_rotvec(0.5 * (rate[1:] + rate[:-1]) * interval_s):
        turned = turned * step
    return turned.as_matrix()


def test_integrated_rates_are_the_angles():
    march = SyntheticMarch(dataclasses.replace(PERFECT, duration=12.0))
    blocks = list(march.samples())
    time_s = np.arange(march.sample_count) / PERFECT.rate
    angle = march.body(time_s).angles["knee_flexion_right"].value
    now = int(np.argmax(angle[3500:5000])) + 3500
    R_world_from = {}
    for index, mount in enumerate(march.mounts):
        rate = np.vstack([block.sensors[index].angular_velocity for block in blocks])[: now + 1]
        R_sensor_from_segment = mount.R_segment_from_sensor.T
        start = mount.R_segment_from_sensor  # standing: every segment in the axes of the world
        R_world_from[mount.description.name] = start @ integrated(rate, 1 / PERFECT.rate) @ R_sensor_from_segment
    knee = R_world_from["thigh_right"].T @ R_world_from["shank_right"]
    # A knee flexes about -z.
    flexed = math.atan2(-knee[1, 0], knee[0, 0])
    assert angle[now] > 0.8
    assert abs(flexed) == pytest.approx(angle[now], abs=0.01)


def test_rates_and_accelerations_of_the_truth_are_its_derivatives():
    march = SyntheticMarch(dataclasses.replace(PERFECT, tempo_changes=1, duration=50.0))
    time_s = np.arange(32.0, 38.0, 1e-3)
    for angle in march.gait.angles(march.strides(time_s)).values():
        for of, derivative in ((angle.value, angle.rate), (angle.rate, angle.acceleration)):
            slope = (of[2:] - of[:-2]) / 2e-3
            assert slope == pytest.approx(derivative[1:-1], abs=2e-3 * max(1.0, np.abs(derivative).max()))


def contacts_s(march, side=Side.RIGHT):
    time_s = np.arange(0.0, march.parameters.duration, 0.002)
    return time_s[1:][np.diff(march.body(time_s).contact[side]) > 0]


def test_every_beat_is_a_cycle():
    march = SyntheticMarch(dataclasses.replace(PERFECT, duration=100.0))
    periods = np.diff(contacts_s(march))[2:-2]
    assert len(periods) > 90
    assert np.mean(periods) == pytest.approx(60.0 / 70.0, rel=2e-3)
    assert 0.01 < np.std(periods) * 70.0 / 60.0 < 0.05
    even = SyntheticMarch(dataclasses.replace(PERFECT, beat_jitter=0.0))
    assert np.diff(contacts_s(even))[1:-1] == pytest.approx(60.0 / 70.0, abs=0.005)


def test_the_beat_changes_every_thirty_seconds():
    march = SyntheticMarch(dataclasses.replace(PERFECT, tempo_changes=1, duration=219.0, beat_jitter=0.0))
    for k, beat in enumerate(PUBLISHED_BEATS_PER_MIN):
        time_s = march.parameters.standing + 30.0 * k + np.linspace(3.0, 28.0, 50)
        assert march.strides(time_s).phase.rate == pytest.approx(beat / 60.0)


def test_the_own_pace_is_the_seed_s():
    paces = [SyntheticMarch(MarchParameters(seed=seed)).timeline.frequency_hz for seed in range(12)]
    assert min(paces) >= 0.85
    assert max(paces) <= 1.1
    assert np.ptp(paces) > 0.1
    assert SyntheticMarch(MarchParameters(pace=1.3)).timeline.frequency_hz == 1.3


@pytest.mark.parametrize("seed", range(4))
def test_thighs_are_lifted_and_the_standing_leg_carries(seed):
    march = SyntheticMarch(dataclasses.replace(PERFECT, seed=seed))
    time_s = np.arange(8.0, 14.0, 0.01)
    body = march.body(time_s)
    hip, knee = (body.angles[f"{name}_flexion_left"].value for name in ("hip", "knee"))
    assert 30.0 < math.degrees(hip.max()) < 75.0
    assert 1.2 * hip.max() < knee.max() < 2.2 * hip.max()
    assert np.ptp(body.pelvis.position[:, 1]) < 0.03
    assert np.abs(body.pelvis.acceleration).max() < 25.0
    assert np.abs(np.diff(body.pelvis.position[[0, -1]], axis=0)).max() < 0.3


def test_no_lift_is_quite_the_last_one():
    march = SyntheticMarch(dataclasses.replace(PERFECT, duration=100.0))
    hip = march.body(np.arange(8.0, 95.0, 0.01)).angles["hip_flexion_right"].value
    peaks = hip[1:-1][(hip[1:-1] > hip[2:]) & (hip[1:-1] > hip[:-2]) & (hip[1:-1] > 0.3)]
    assert 0.02 < np.std(peaks) / np.mean(peaks) < 0.08


def test_the_source_is_the_march(tmp_path):
    spec = "synthetic:march?duration=10&seed=4&metronome=80"
    source = open_source(spec)
    assert "80 per min" in source.describe().title
    assert source.describe().hubs[0].sensors[0].rate_hz == 50.0
    made = list(iter_messages(source))
    write_recording(tmp_path / "march", "duration=10&seed=4&metronome=80", motion="march")
    replayed = list(iter_messages(open_source(str(tmp_path / "march"))))
    assert [message.envelope for message in made] == [message.envelope for message in replayed]
    assert "synth --march" in (tmp_path / "march" / "recording.toml").read_text()


def test_what_it_cannot_do_is_refused():
    with pytest.raises(InvalidOption, match="synthetic march has no option 'speed'"):
        open_source("synthetic:march?speed=1")
    with pytest.raises(UnknownSource, match=r"synthetic:walk and synthetic:march"):
        open_source("synthetic:swim")
