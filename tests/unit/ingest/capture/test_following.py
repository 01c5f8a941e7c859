"""Who is followed: ids change, people cross, leave and come back."""

import numpy as np
import pytest

from services.ingest.capture.following import NOBODY, Follower
from services.ingest.capture.people import SeenBody
from tests.unit.ingest.capture.two_people import FRAME_NS, JOINTS, Actor, between, ids, play, walk

PATIENT_AT = (-2.5, 0.1)


def test_one_person_is_followed_after_a_second_and_for_good():
    patient = Actor(1.7, PATIENT_AT, 7)
    told = play([patient], 10.0)
    assert {number for number, _ in between(told, 0.0, 0.95)} == {None}
    assert set(between(told, 1.1, 10.0)) == {(1, patient)}


def test_an_empty_room_has_nobody():
    told = play([], 3.0)
    assert {(number, actor) for _, number, actor in told} == {(None, None)}


def test_the_one_at_the_axis_is_chosen_not_the_therapist_beside():
    patient, therapist = Actor(1.7, PATIENT_AT, 12), Actor(1.8, (-2.2, 0.9), 3)
    for seed in range(5):
        told = play([therapist, patient], 4.0, seed=seed)
        assert {actor for number, actor in between(told, 1.2, 4.0)} == {patient}


def test_who_passes_at_the_start_is_not_chosen():
    """The passer-by is nearest to the axis for a moment; the patient stands."""
    patient = Actor(1.7, (-2.5, 0.6), 1)
    passing = Actor(1.8, walk((0, -2.0, -1.5), (2.5, -2.0, 1.5), (3.0, -2.0, 3.0)), lambda t: 2 if t < 2.8 else None)
    told = play([patient, passing], 6.0)
    assert passing not in {actor for _, _, actor in told}
    assert set(between(told, 3.1, 6.0)) == {(1, patient)}


def test_somebody_who_never_stands_still_is_chosen_too():
    walker = Actor(1.7, lambda t: (-2.5 + 0.9 * np.sin(1.5 * t), 0.0), 4)
    told = play([walker], 8.0)
    assert set(between(told, 3.2, 8.0)) == {(1, walker)}


@pytest.mark.parametrize("away_s", [0.0, 0.3, 1.0, 1.8])
def test_a_new_id_at_the_same_place_is_the_same_person(away_s):
    patient = Actor(1.7, PATIENT_AT, ids((0, 5), (4.0, None), (4.0 + away_s, 99)))
    told = play([patient], 10.0)
    assert {number for _, number, _ in told} <= {None, 1}
    assert set(between(told, 4.0 + away_s + 0.1, 10.0)) == {(1, patient)}


def test_ids_that_change_all_the_time_are_one_person():
    patient = Actor(1.7, PATIENT_AT, lambda t: 100 + int(t / 0.7))
    told = play([patient], 12.0)
    assert set(between(told, 3.2, 12.0)) == {(1, patient)}


def test_an_id_given_again_soon_is_the_same_person_and_later_another():
    soon = Actor(1.7, PATIENT_AT, ids((0, 5), (4.0, None), (5.0, 5)))
    assert set(between(play([soon], 8.0), 5.1, 8.0)) == {(1, soon)}
    late = Actor(1.7, PATIENT_AT, ids((0, 5), (4.0, None), (7.0, 5)))
    told = play([late], 12.0)
    assert set(between(told, 4.1, 7.9)) == {(None, None)}
    assert set(between(told, 8.2, 12.0)) == {(2, late)}


@pytest.mark.parametrize("seed", range(4))
def test_a_second_person_walking_through_in_front_does_not_steal(seed):
    """The patient is hidden for 0.6 s while the other is in between, and comes back under a new id."""
    patient = Actor(1.7, PATIENT_AT, ids((0, 1), (4.7, None), (5.3, 3)))
    passing = Actor(1.7, walk((3.0, -1.6, -1.6), (7.0, -1.6, 1.8)), lambda t: 2 if 3.0 <= t <= 7.0 else None)
    told = play([patient, passing], 10.0, seed=seed)
    assert passing not in {actor for _, _, actor in told}
    assert {number for _, number, _ in told} <= {None, 1}
    assert set(between(told, 5.5, 10.0)) == {(1, patient)}


def test_ids_exchanged_at_the_crossing_are_exchanged_back():
    """As trackers do it: from the crossing on the patient has the other's id."""
    patient = Actor(1.7, PATIENT_AT, ids((0, 1), (5.0, 2)))
    passing = Actor(1.7, walk((3.0, -1.7, -1.6), (7.0, -1.7, 1.8)), ids((0, None), (3.0, 2), (5.0, 1), (7.0, None)))
    told = play([patient, passing], 10.0)
    assert set(between(told, 1.2, 10.0)) == {(1, patient)}


def test_the_patients_id_that_jumps_to_the_other_is_not_believed():
    """Hidden, the patient is gone for 0.5 s and the tracker puts the id onto the one in front."""
    patient = Actor(1.7, PATIENT_AT, ids((0, 1), (4.8, None), (5.3, 8)))
    passing = Actor(1.6, walk((3.0, -1.6, -1.6), (7.0, -1.6, 1.8)), ids((0, None), (3.0, 2), (4.8, 1), (7.0, None)))
    told = play([patient, passing], 10.0)
    assert passing not in {actor for _, _, actor in told}
    assert set(between(told, 5.6, 10.0)) == {(1, patient)}


def test_both_lose_their_ids_while_crossing():
    patient = Actor(1.7, PATIENT_AT, ids((0, 1), (4.7, None), (5.3, 4)))
    seen = ids((0, None), (3.0, 2), (4.7, None), (5.2, 3), (7.0, None))
    other = Actor(1.7, walk((3.0, -3.6, -1.6), (7.0, -3.6, 1.8)), seen)
    told = play([patient, other], 10.0)
    assert other not in {actor for _, _, actor in told}
    assert set(between(told, 5.5, 10.0)) == {(1, patient)}


def test_two_who_walk_through_each_other_keep_who_is_who():
    """The patient walks to the camera while another walks away; both ids change as they meet."""
    patient = Actor(1.75, walk((2.0, -3.6, 0.0), (6.0, -1.4, 0.3)), ids((0, 1), (3.9, None), (4.2, 12)))
    other = Actor(1.6, walk((2.0, -1.3, 0.9), (6.0, -3.6, 0.9)), ids((0, 2), (3.9, None), (4.2, 11)))
    told = play([patient, other], 8.0)
    assert other not in {actor for _, _, actor in told}
    assert {number for _, number, _ in told} <= {None, 1}
    assert set(between(told, 4.5, 8.0)) == {(1, patient)}


def test_somebody_of_another_size_at_the_same_place_is_another_body():
    tall = Actor(1.85, PATIENT_AT, lambda t: 1 if t < 4.0 else None)
    child = Actor(1.25, PATIENT_AT, lambda t: 2 if t >= 4.5 else None)
    told = play([tall, child], 12.0)
    assert set(between(told, 4.1, 6.0)) == {(None, None)}
    assert set(between(told, 7.0, 12.0)) == {(2, child)}


def test_who_leaves_and_comes_back_is_counted_anew():
    patient = Actor(1.7, walk((4.0, -2.5, 0.1), (6.0, -2.5, 2.4), (9.0, -2.5, 2.4), (11.0, -2.5, 0.0)),
                    ids((0, 1), (6.0, None), (9.0, 2)))  # fmt: skip
    told = play([patient], 15.0)
    assert set(between(told, 6.1, 9.0)) == {(None, None)}
    assert set(between(told, 12.2, 15.0)) == {(2, patient)}


def test_the_therapist_beside_waits_until_the_patient_is_gone_for_long():
    patient = Actor(1.7, PATIENT_AT, ids((0, 1), (4.0, None), (11.0, 5)))
    therapist = Actor(1.75, (-2.3, 0.8), 2)
    told = play([patient, therapist], 20.0)
    assert therapist not in {actor for _, _, actor in told}
    assert set(between(told, 12.3, 20.0)) == {(2, patient)}
    for_good = Actor(1.7, PATIENT_AT, lambda t: 1 if t < 4.0 else None)
    told = play([for_good, therapist], 20.0)
    assert set(between(told, 4.1, 13.9)) == {(None, None)}
    assert set(between(told, 14.2, 20.0)) == {(2, therapist)}


def test_a_therapist_who_gets_a_new_id_meanwhile_is_still_beside():
    patient = Actor(1.7, PATIENT_AT, ids((0, 1), (4.0, None), (11.0, 9)))
    therapist = Actor(1.75, (-2.3, 0.8), ids((0, 2), (5.0, None), (5.5, 3)))
    told = play([patient, therapist], 16.0)
    assert therapist not in {actor for _, _, actor in told}
    assert set(between(told, 12.3, 16.0)) == {(2, patient)}


def test_the_therapist_steps_close_while_the_patient_is_hidden():
    """At half a metre, and of the same size: who was seen beside the patient is not the patient."""
    patient = Actor(1.7, PATIENT_AT, ids((0, 1), (5.0, None), (6.5, 4)))
    therapist = Actor(1.7, walk((3.0, -2.3, 1.2), (5.0, -2.3, 0.6), (6.5, -2.3, 0.6), (8.0, -2.3, 1.2)), 2)
    told = play([patient, therapist], 10.0)
    assert therapist not in {actor for _, _, actor in told}
    assert set(between(told, 6.7, 10.0)) == {(1, patient)}


def test_who_walks_on_while_hidden_is_expected_further_on():
    patient = Actor(1.7, walk((2.0, -2.5, -1.5), (5.0, -2.5, 1.8)), ids((0, 1), (3.0, None), (4.0, 2)))
    told = play([patient], 7.0)
    assert set(between(told, 4.1, 7.0)) == {(1, patient)}


def test_a_body_that_comes_back_in_pieces_is_given_time():
    """For the first frames after the loss the camera's bones are far too short."""
    patient = Actor(1.7, PATIENT_AT, lambda t: 1 if t < 4.0 else None)
    torn = Actor(1.2, PATIENT_AT, lambda t: 2 if 4.5 <= t < 4.6 else None)
    whole = Actor(1.7, PATIENT_AT, lambda t: 2 if t >= 4.6 else None)
    told = play([patient, torn, whole], 8.0)
    assert set(between(told, 4.9, 8.0)) == {(1, whole)}


def test_an_id_given_again_to_somebody_else_is_not_believed():
    patient = Actor(1.8, PATIENT_AT, lambda t: 5 if t < 4.0 else None)
    child = Actor(1.2, (-2.0, 0.9), lambda t: 5 if t >= 5.0 else None)
    told = play([patient, child], 8.0)
    assert {number for number, _ in between(told, 4.1, 5.9)} == {None}
    assert (1, child) not in between(told, 4.1, 8.0)


def test_somebody_far_behind_on_the_axis_is_not_chosen():
    patient, behind = Actor(1.7, (-2.3, 0.2), 1), Actor(1.7, (-4.2, 0.0), 2)
    assert {actor for _, actor in between(play([patient, behind], 4.0), 1.2, 4.0)} == {patient}


def test_noise_and_lost_frames_change_nothing():
    patient, therapist = Actor(1.7, PATIENT_AT, 1), Actor(1.75, (-2.3, 0.9), 2)
    told = play([patient, therapist], 20.0, noise=0.05, drop=0.15)
    assert set(between(told, 1.5, 20.0)) == {(1, patient)}


def test_single_frames_far_off_are_left_out():
    patient = Actor(1.7, lambda t: (-2.5, 1.4) if round(t * 30) % 60 == 45 else PATIENT_AT, 1)
    told = play([patient], 10.0)
    assert {number for number, _ in between(told, 2.0, 10.0)} == {None, 1}
    off = [t for t, number, _ in told if t > 2.0 and number is None]
    assert all(round(t * 30) % 60 == 45 for t in off)


def test_a_body_without_a_trunk_is_nobody_for_the_while():
    follower = Follower(JOINTS)
    patient = Actor(1.7, PATIENT_AT, 1)
    rng = np.random.default_rng(0)
    for k in range(90):
        body = patient.body(k / 30, rng, 0.01)
        if k in (60, 61):
            body = SeenBody(1, np.full((len(JOINTS), 3), np.nan), np.zeros(len(JOINTS), dtype=bool))
        followed = follower.take(k * FRAME_NS, [body])
        assert (followed == NOBODY) == (k in (60, 61) or k <= 30)


def test_strangers_without_end_are_forgotten():
    """Ten new ids in each frame: what is remembered stays bounded."""
    follower = Follower(JOINTS)
    rng = np.random.default_rng(0)
    for k in range(150):
        bodies = [Actor(1.7, (-2.0 - 0.5 * j, j - 5.0), 10 * k + j).body(0.0, rng, 0.02) for j in range(10)]
        follower.take(k * FRAME_NS, bodies)
    assert len(follower._people._people) <= 32


def test_it_is_deterministic_whatever_the_order_of_bodies():
    patient = Actor(1.7, PATIENT_AT, ids((0, 1), (4.7, None), (5.3, 3)))
    other = Actor(1.7, walk((3.0, -1.6, -1.6), (7.0, -1.6, 1.8)), lambda t: 2 if 3.0 <= t <= 7.0 else None)
    told = [play([patient, other], 9.0, seed=seed, noise=0.0) for seed in (1, 2)]
    assert told[0] == told[1]


def random_clinic(seed):
    """A patient who is hidden every few seconds, mostly by somebody walking through, and a therapist beside."""
    rng = np.random.default_rng(seed)
    side, z = rng.uniform(-0.3, 0.3), rng.uniform(1.0, 1.4) * rng.choice([-1, 1])
    spans, hidden, t = [(0, 1)], [], 3.0 + rng.uniform(0, 2)
    while t < 26:
        away_s = rng.uniform(0.0, 1.8)
        spans += [(t, None), (t + away_s, 100 + len(spans))]
        hidden.append(t + 0.5 * away_s)
        t += away_s + rng.uniform(2.5, 6)
    patient = Actor(rng.uniform(1.5, 1.9), lambda t: (-2.5 + 0.15 * np.sin(2 * t), side), ids(*spans))
    therapist = Actor(rng.uniform(1.5, 1.9), lambda t: (-2.2, z + 0.2 * np.sin(t)), lambda t: 50 + int(t / 8.0))
    passing = []
    for k, middle in enumerate(hidden):
        speed, depth = rng.uniform(0.8, 1.4) * rng.choice([-1, 1]), rng.uniform(-1.9, -1.3)
        path = walk((middle - 2, depth, -2 * speed), (middle + 2, depth, 2 * speed))
        passing.append(
            Actor(rng.uniform(1.5, 1.9), path, ids((0, None), (middle - 1.6, 1000 + k), (middle + 1.6, None)))
        )
    return patient, [patient, therapist, *passing]


@pytest.mark.parametrize("seed", range(100, 106))
def test_in_a_busy_clinic_nobody_else_is_ever_followed(seed):
    patient, everybody = random_clinic(seed)
    told = play(everybody, 30.0, noise=0.03, seed=seed, drop=0.03)
    assert {actor for _, _, actor in told} <= {None, patient}
    in_view = [actor for t, _, actor in told if t > 2.0 and patient.ids(t) is not None]
    assert in_view.count(patient) > 0.9 * len(in_view)
