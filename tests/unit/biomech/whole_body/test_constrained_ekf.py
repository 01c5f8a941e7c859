"""The constrained filter: its algebra against the textbook, its promises on a moving person."""

from dataclasses import replace

import numpy as np
import pytest

from services.biomech.whole_body import textbook
from services.biomech.whole_body.constrained_ekf import FilterSettings, WholeBodyEkf
from services.biomech.whole_body.model import CENTRE_NAMES, DOF
from services.biomech.whole_body.parameters import (
    LIMITS_DEG,
    NO_PRIORS,
    CameraNoise,
    ProcessNoise,
    per_angle,
)

PLAIN = FilterSettings(
    camera=CameraNoise(variance=1e-3, along=0.0, inferred=1.0, stretch=0.0, gate=0.0, swap_share=0.0),
    priors=NO_PRIORS,
    constrained=False,
)
KNEE = 3 + DOF["knee_flexion_right"]


def run(ekf, person, centres, state=None):
    for k, frame in enumerate(centres):
        ekf.advance(person.dt if k else 0.0, frame, person.tracked if state is None else state[k])
        yield ekf


@pytest.mark.parametrize("biased", [True, False])
@pytest.mark.parametrize("held", [True, False])
def test_a_step_is_the_textbook_in_joseph_form(person, biased: bool, held: bool) -> None:
    settings = replace(PLAIN, process=replace(ProcessNoise(), held=held))
    ekf = WholeBodyEkf(person.start(biased=biased), settings)
    frames = person.seen(person.squats(3), 0.01)
    frames[2, 4] = np.nan
    list(run(ekf, person, frames[:2]))
    n = len(ekf.x)
    F = textbook.transition(n, person.dt)
    Q = textbook.process_noise(n, person.dt, settings.process.densities(), held=held)
    x, P = textbook.update(person.body, F @ ekf.x, F @ ekf.P @ F.T + Q, frames[2], np.full(15, 1e-3))
    ekf.advance(person.dt, frames[2], person.tracked)
    assert ekf.x == pytest.approx(x, abs=1e-10)
    assert np.abs(ekf.P - P).max() < 1e-10


def test_noise_along_the_bone_is_believed_less_along_the_bone(person) -> None:
    """A knee seen 5 cm farther down the thigh lengthens it less; one seen 5 cm aside turns it as before."""
    frame = person.centres(person.standing())
    knee = CENTRE_NAMES.index("knee_right")
    moved = {}
    for along in (0.0, 0.5):
        for axis in (1, 2):
            ekf = WholeBodyEkf(person.start(), replace(PLAIN, camera=replace(PLAIN.camera, along=along)))
            before = person.body.centres(ekf.q, ekf.lengths)[knee]
            pushed = frame.copy()
            pushed[knee, axis] -= 0.05
            ekf.advance(0.0, pushed, person.tracked)
            moved[along, axis] = np.linalg.norm(person.body.centres(ekf.q, ekf.lengths)[knee] - before)
    assert moved[0.5, 1] < 0.5 * moved[0.0, 1]
    assert moved[0.5, 2] > 0.8 * moved[0.0, 2]


def test_covariance_stays_symmetric_and_positive(person) -> None:
    frames = person.seen(person.squats(300), 0.02)
    generator = np.random.default_rng(3)
    for k in range(0, 300, 7):
        frames[k, generator.integers(15)] += generator.normal(0.0, 0.3, 3)
    for ekf in run(WholeBodyEkf(person.start()), person, frames):
        assert (ekf.P == ekf.P.T).all()
    assert np.linalg.eigvalsh(ekf.P).min() > 0.0
    assert ekf.is_sound()


def test_bounds_are_always_met(person) -> None:
    """The camera bends knees the wrong way and stretches every bone by half."""
    q = person.squats(150, depth_deg=200.0)
    q[:, KNEE] = -0.6
    frames = 1.5 * person.seen(q, 0.03)
    start = person.start(biased=False)
    low, high = per_angle(LIMITS_DEG).T
    active = 0
    for ekf in run(WholeBodyEkf(start), person, frames):
        assert (ekf.estimate[3:25] == ekf.angles).all()
        assert (ekf.angles >= low).all()
        assert (ekf.angles <= high).all()
        assert (np.abs(ekf.lengths / start.lengths - 1.0) <= 0.2 + 1e-12).all()
        active += ekf.active
    assert active > 100


def test_follows_a_squat(person) -> None:
    q = person.squats(240)
    errors = [
        ekf.x[KNEE] - truth[KNEE]
        for ekf, truth in zip(run(WholeBodyEkf(person.start()), person, person.seen(q, 0.01)), q, strict=True)
    ]
    assert np.degrees(np.sqrt(np.mean(np.square(errors[30:])))) < 4.0


def test_without_a_centre_it_only_predicts(person) -> None:
    frames = person.seen(person.squats(40), 0.01)
    ekf = WholeBodyEkf(person.start(), PLAIN)
    list(run(ekf, person, frames))
    expected = textbook.transition(len(ekf.x), person.dt) @ ekf.x
    ekf.advance(person.dt, np.full((15, 3), np.nan), person.tracked)
    assert ekf.x == pytest.approx(expected, abs=1e-12)
    assert ekf.evidence()[0] == 0


def test_an_inferred_centre_weighs_less(person) -> None:
    frame = person.centres(person.standing())
    frame[CENTRE_NAMES.index("ankle_right"), 0] -= 0.04
    bent = []
    for state in (2, 1):
        ekf = WholeBodyEkf(person.start())
        states = person.tracked.copy()
        states[CENTRE_NAMES.index("ankle_right")] = state
        ekf.advance(0.0, frame, states)
        bent.append(ekf.x[KNEE] - person.standing()[KNEE])
    assert 0.0 < bent[1] < 0.4 * bent[0]


def test_a_jump_is_believed_less(person) -> None:
    frames = person.seen(np.repeat(person.standing()[None], 31, axis=0), 0.005)
    frames[30, CENTRE_NAMES.index("knee_right"), 0] += 0.4
    moved = []
    for gate in (9.0, 0.0):
        ekf = WholeBodyEkf(person.start(), FilterSettings(camera=CameraNoise(gate=gate, stretch=0.0)))
        list(run(ekf, person, frames[:30]))
        before = ekf.x[KNEE]
        ekf.advance(person.dt, frames[30], person.tracked)
        moved.append(abs(np.degrees(ekf.x[KNEE] - before)))
    assert ekf.distances()[CENTRE_NAMES.index("knee_right")] > 20.0
    assert moved[0] < 0.2 * moved[1]


def test_a_bone_of_wrong_length_is_believed_less(person) -> None:
    """A wrist seen 15 cm beyond the forearm's end."""
    frame = person.centres(person.standing())
    wrist = CENTRE_NAMES.index("wrist_right")
    frame[wrist] += 0.6 * (frame[wrist] - frame[CENTRE_NAMES.index("elbow_right")])
    longer = []
    for stretch in (0.06, 0.0):
        ekf = WholeBodyEkf(person.start(), replace(PLAIN, camera=replace(PLAIN.camera, stretch=stretch)))
        ekf.advance(0.0, frame, person.tracked)
        longer.append(ekf.lengths[10] - person.lengths[10])
    assert 0.0 < longer[0] < 0.5 * longer[1]


def test_lengths_are_held_after_five_seconds(person) -> None:
    lengths = [
        ekf.lengths.copy() for ekf in run(WholeBodyEkf(person.start()), person, person.seen(person.squats(240), 0.02))
    ]
    assert np.abs(np.diff(lengths[:100], axis=0)).max() > 1e-5
    assert np.ptp(lengths[160:], axis=0).max() < 1e-5


def test_exchanged_legs_are_exchanged_back(person) -> None:
    q = person.squats(90)
    frames = person.seen(q, 0.005)
    legs = [CENTRE_NAMES.index(name) for name in ("hip_right", "knee_right", "ankle_right")]
    given, swapped = WholeBodyEkf(person.start()), WholeBodyEkf(person.start())
    list(run(given, person, frames))
    other = frames.copy()
    for leg in legs:
        other[50:60, [leg, leg + 3]] = other[50:60, [leg + 3, leg]]
    flags = [ekf.swapped for ekf in run(swapped, person, other)]
    assert flags == [50 <= k < 60 for k in range(90)]
    assert (swapped.x == given.x).all()


def test_offsets_of_the_camera_are_found_from_standing(person) -> None:
    """Both knees seen 4 cm too far forward: without bias states that is a bent knee."""
    frames = person.seen(np.repeat(person.standing()[None], 60, axis=0), 0.005)
    frames[:, [CENTRE_NAMES.index("knee_right"), CENTRE_NAMES.index("knee_left")], 0] += 0.04
    errors = []
    for biased in (True, False):
        ekf = WholeBodyEkf(person.start(biased=biased))
        list(run(ekf, person, frames))
        errors.append(abs(np.degrees(ekf.x[KNEE] - person.standing()[KNEE])))
    assert errors[0] < 0.5 * errors[1]


def test_priors_tell_the_same_per_second_at_every_rate(person) -> None:
    q = np.repeat(person.standing()[None], 120, axis=0)
    q[:, 3 + DOF["hip_internal_rotation_right"]] += 0.4
    found = []
    for step in (1, 2):
        ekf = WholeBodyEkf(person.start())
        for k in range(0, 120, step):
            ekf.advance(step * person.dt if k else 0.0, person.centres(q[k]), person.tracked)
        found.append(ekf.deviations()[0][DOF["hip_internal_rotation_right"]])
    assert found[0] == pytest.approx(found[1], rel=0.1)


def test_settling_keeps_the_posture_and_forgets_the_motion(person) -> None:
    ekf = WholeBodyEkf(person.start())
    list(run(ekf, person, person.seen(person.squats(50), 0.005)))
    angles, lengths = ekf.angles.copy(), ekf.lengths.copy()
    ekf.settle()
    assert (ekf.angles == angles).all()
    assert (ekf.lengths == lengths).all()
    assert not ekf.rates.any()
    assert np.linalg.eigvalsh(ekf.P).min() > 0.0


def test_what_was_is_told_better_a_little_later(person) -> None:
    """In the light of three more frames the knee of a squat is known better than at once, and within its limits."""
    q = person.squats(240)
    at_once, later = [], []
    for k, ekf in enumerate(run(WholeBodyEkf(person.start()), person, person.seen(q, 0.02))):
        if k >= 33:
            at_once.append(ekf.angles - q[k, 3:])
            later.append(ekf.angles_before(3 * person.dt) - q[k - 3, 3:])
    assert (ekf.angles_before(0.0) == ekf.angles).all()
    knee = DOF["knee_flexion_right"]
    error = [np.sqrt(np.mean(np.square([row[knee] for row in rows]))) for rows in (at_once, later)]
    assert error[1] < 0.9 * error[0]
    assert (ekf.angles_before(0.2) >= per_angle(LIMITS_DEG)[:, 0]).all()
