"""Every dial of the synthetic people, and how it is written in `synthetic:walk?speed=1.1&seed=3`."""

import math
from dataclasses import dataclass
from typing import ClassVar

from services.ingest.synthetic.dials import Dials, dial
from services.ingest.synthetic.kinds import KINDS
from services.ingest.synthetic.whole_body.parameters import BesideSensorsParameters


@dataclass(frozen=True)
class SessionParameters(Dials):
    """What every synthetic session has: a body, a schedule of standing and moving, and the sensors that see it.

    All in SI; unlikely but possible bodies are allowed, impossible ones not.
    """

    duration: float = dial(60.0, 5.0, 8 * 3600.0, "s, standing included")
    seed: int = dial(0, 0, 2**31, "of everything random: noise, bias, mounting, wander, a person's own way")
    wander: float = dial(0.02, 0.0, 0.1, "standard deviation of cadence over time, relative")
    standing: float = dial(4.0, 3.0, 600.0, "s of quiet standing at the start")
    stop_every: float = dial(0.0, 0.0, 3600.0, "s of moving between stops; 0 never stops")
    pause: float = dial(5.0, 1.0, 600.0, "s of standing at each stop and at the end")
    rate: float = dial(100.0, 20.0, 1000.0, "Hz of every sensor")
    feet: int = dial(0, 0, 1, "1 adds a sensor on each shoe")
    worn: int = dial(0, 0, 3, "0 pelvis and both legs, 1 the left leg alone, 2 the right leg, 3 the pelvis")
    misworn: int = dial(
        0, 0, 3, "0 as declared, 1 thigh and shank sensors swapped, 2 thigh sensors upside down, 3 shank sensors"
    )
    truth: int = dial(1, 0, 1, "0 leaves out the reference stream")
    gyro_noise: float = dial(0.005, 0.0, 1.0, "rad/s, standard deviation per sample")
    accel_noise: float = dial(0.05, 0.0, 5.0, "m/s^2, standard deviation per sample")
    gyro_bias: float = dial(0.01, 0.0, 0.2, "rad/s, standard deviation per axis at the start")
    gyro_drift: float = dial(0.0, 0.0, 0.1, "rad/s that each axis's bias changes in 10 min, standard deviation")
    accel_bias: float = dial(0.03, 0.0, 0.3, "m/s^2, standard deviation per axis, constant in a session")
    mounting: float = dial(0.26, 0.0, math.pi, "rad, largest rotation of a sensor against its nominal placement")
    soft_tissue: float = dial(0.0, 0.0, 0.2, "rad, amplitude of the thigh sensor's wobble; the shank's is 0.4 of it")
    thigh_length: float = dial(0.41, 0.2, 0.6, "m, hip centre to knee centre")
    shank_length: float = dial(0.40, 0.2, 0.6, "m, knee centre to ankle centre")
    hip_width: float = dial(0.18, 0.08, 0.35, "m, between the hip centres")
    tape: float = dial(0.0, 0.0, 0.1, "relative standard deviation of each length of the body as declared")


@dataclass(frozen=True)
class BeforeCameraParameters(BesideSensorsParameters, SessionParameters):
    """A session that a camera may look at: the person stays where it stands, on a treadmill or on the spot."""


@dataclass(frozen=True)
class WalkParameters(BeforeCameraParameters):
    """A walk."""

    motion: ClassVar[str] = "walk"

    speed: float = dial(1.1, 0.3, 1.6, "m/s, mean over a stride on the straight")
    asymmetry: float = dial(0.0, 0.0, 0.5, "share by which the left leg swings less; its steps also come off beat")
    turn_every: float = dial(0.0, 0.0, 3600.0, "s from turn to turn; 0 walks straight on")
    turn_angle: float = dial(math.pi, 0.0, 2 * math.pi, "rad per turn, to the left and to the right in turn")
    turn_time: float = dial(3.0, 1.0, 30.0, "s that a turn takes")
    patient: int = dial(0, 0, 4, "manner of walking, also of a healthy body drawn by the seed", words=KINDS)
    affected: int = dial(2, 1, 2, "leg of the patient that differs", words=("", "left", "right"))


@dataclass(frozen=True)
class MarchParameters(BeforeCameraParameters):
    """Marching on the spot, as in the trials of Joukov et al. (section IV-B): two minutes at 50 Hz.

    Their 70 steps per minute are 1.167 Hz of the right knee, so that a beat is one cycle of a leg.
    """

    motion: ClassVar[str] = "march"

    duration: float = dial(129.0, 5.0, 8 * 3600.0, "s, standing included")
    rate: float = dial(50.0, 20.0, 1000.0, "Hz of every sensor")
    metronome: float = dial(0.0, 0.0, 110.0, "beats per minute, one a cycle of a leg; 0 marches at the own pace")
    tempo_changes: int = dial(0, 0, 1, "1: the beat changes every 30 s, 70 60 50 60 70 80 70 per minute")
    pace: float = dial(0.0, 0.0, 1.6, "cycles/s of the own pace; 0 draws it from the seed")
    lift: float = dial(0.0, 0.0, 1.5, "rad, how high the thigh is lifted; 0 draws it from the seed")
    beat_jitter: float = dial(0.015, 0.0, 0.05, "standard deviation of a cycle's beginning, in cycles")
    lift_jitter: float = dial(0.05, 0.0, 0.2, "standard deviation of the lift from cycle to cycle, relative")


@dataclass(frozen=True)
class TugParameters(SessionParameters):
    """The timed up and go: rise from a chair, walk out, turn, walk back, turn and sit down."""

    motion: ClassVar[str] = "tug"

    duration: float = dial(0.0, 0.0, 8 * 3600.0, "s, standing included; 0: as long as all attempts take")
    speed: float = dial(1.1, 0.3, 1.6, "m/s, mean over a stride on the straight")
    asymmetry: float = dial(0.0, 0.0, 0.5, "share by which the left leg swings less; its steps also come off beat")
    walkway: float = dial(3.0, 1.5, 20.0, "m from the chair to the turning point, to within a step")
    attempts: int = dial(1, 0, 20, "times that the whole test is done")
    pause: float = dial(5.0, 1.0, 600.0, "s of sitting before each attempt and after the last")
    seated_start: int = dial(0, 0, 1, "1 begins sitting; 0 stands first, then sits down")
    stroll: int = dial(0, 0, 50, "strides of walking after the standing, before sitting down for the first time")
    seat_height: float = dial(0.46, 0.3, 0.6, "m, floor to seat; the legs' length decides whether it is low or high")
    rise_time: float = dial(1.6, 0.8, 8.0, "s from the trunk's first motion to upright")
    sit_time: float = dial(1.8, 0.8, 8.0, "s from upright to the seat")
    turn_time: float = dial(2.0, 1.0, 12.0, "s that each turn takes")
    turn_steps: int = dial(2, 1, 6, "parts in which a turn is made; 1 turns at an even sweep")
    hesitation: float = dial(0.0, 0.0, 20.0, "s of standing before the turn at the marker")
    fidget: float = dial(0.03, 0.0, 0.15, "rad, standard deviation of the trunk's restlessness while seated")
    false_starts: int = dial(0, 0, 5, "times that the person rises and sits down again before the first attempt")
    aborted: int = dial(0, 0, 5, "attempts before the first whole one that end on a chair brought after a few steps")


@dataclass(frozen=True)
class KneeParameters(SessionParameters):
    """Repetitions of an exercise of one knee; nobody walks."""

    motion: ClassVar[str] = "knee"

    duration: float = dial(90.0, 10.0, 8 * 3600.0, "s, standing and rests included")
    standing: float = dial(0.0, 0.0, 600.0, "s of quiet standing at the start; 0 begins in the exercise's position")
    worn: int = dial(2, 0, 3, "as in every session; the right knee exercises unless the left leg alone wears")
    exercise: int = dial(1, 1, 5, "1 seated extension, 2 heel slide, 3 squat, 4 cycling, 5 sit to stand")
    tempo: float = dial(15.0, 2.0, 120.0, "repetitions per minute within a set, at the start")
    range: float = dial(0.0, 0.0, 2.2, "rad of knee flexion from end to end; 0 is what is usual for the exercise")
    deficit: float = dial(0.0, 0.0, 1.0, "rad of flexion that remains in the most extended knee; 0 is what is usual")
    hold: float = dial(0.0, 0.0, 15.0, "s that the far side is held")
    breath: float = dial(0.4, 0.0, 20.0, "s of rest after each repetition")
    set_of: int = dial(0, 0, 1000, "repetitions in a set; 0 makes one set of all")
    rest: float = dial(5.0, 1.0, 600.0, "s of rest before the first repetition and between sets")
    jitter: float = dial(0.05, 0.0, 0.2, "standard deviation of time and range from repetition to repetition, relative")
    fatigue: float = dial(0.0, 0.0, 0.8, "share of the range that is lost by the end")
    slowing: float = dial(0.0, 0.0, 0.8, "share of the tempo that is lost by the end")
    hesitations: float = dial(0.0, 0.0, 1.0, "share of repetitions that stop half-way out")
    partials: float = dial(0.0, 0.0, 0.5, "share of repetitions that go less than half as far")
    tremor: float = dial(0.0, 0.0, 0.1, "rad, amplitude of a tremor of 5 Hz of the knee")
