import csv
import io
import math

import numpy as np
import pytest

from schemas.conditions import UNSAID
from services.exports.facts import Facts, conditions_in_words
from services.exports.session import facts_of
from services.exports.tables.csv_file import CsvFile, csv_text
from services.exports.tables.kinds import TABLES


def table(name, session):
    text = b"".join(csv_text(name, facts_of(session), session.payloads(TABLES[name].signal))).decode()
    head = [line[2:] for line in text.splitlines() if line.startswith("# ")]
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    return head, rows


@pytest.mark.parametrize("name", TABLES)
def test_every_table_says_what_it_is_of_and_defines_its_columns(name, walk):
    head, rows = table(name, walk)
    text = "\n".join(head)
    assert "session: s1, started 2026-" in text
    assert "conditions: aid cane, footwear shoes" in text
    assert "datum of angles: quiet standing" in text
    assert "computed by: ambula 0.0.1+abc" in text
    assert "initial contact of the same foot. Steps are named by the leading leg." in text
    assert rows
    plain = {
        "side",
        "index",
        "event",
        "name",
        "task",
        "phase",
        "valid",
        "grade",
        "degree_of_freedom",
        "attempt",
        "joint",
    }
    undefined = {column for column in rows[0] if not any(line.startswith(f"{column}: ") for line in head)}
    assert undefined <= plain


@pytest.mark.parametrize("name", TABLES)
def test_nothing_in_a_table_names_a_person_or_is_not_a_number(name, walk):
    head, rows = table(name, walk)
    assert walk.description.title not in "\n".join(head)
    assert "nan" not in {cell.lower() for row in rows for cell in row.values()}


def test_angles_are_degrees_in_columns_that_say_so_with_their_direction(walk, made):
    head, rows = table("joint_angles", walk)
    assert "knee_flexion_left_deg: degrees, positive = shank backward" in head
    assert len(rows) == 1000
    angle = made.angles_at("lower_body", np.array([made.start_ns * 1e-9]))[0, 12]
    assert float(rows[0]["knee_flexion_left_deg"]) == pytest.approx(math.degrees(angle), abs=1e-4)
    assert float(rows[0]["time_s"]) == pytest.approx(2.24)


def test_an_angle_that_is_not_valid_is_an_empty_cell(about, made):
    state = made.joint_states(count=3, valid=[f != 3 for f in range(15)])[0]
    text = b"".join(csv_text("joint_angles", Facts(about), [state])).decode()
    row = next(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    assert row["hip_flexion_right_deg"] == row["hip_flexion_right_std_deg"] == ""
    assert row["hip_adduction_right_deg"] != ""


def test_the_columns_of_angles_are_those_of_the_body_model(seen):
    _, rows = table("joint_angles", seen)
    assert "trunk_flexion_deg" in rows[0]
    assert len(rows[0]) == 1 + 2 * 24


def test_metrics_are_in_their_own_unit_and_angles_in_degrees_beside(walk):
    head, rows = table("metrics", walk)
    of = {row["name"]: row for row in rows}
    assert float(of["cadence"]["value"]) == 108
    assert of["cadence"]["value_deg"] == ""
    assert of["knee_flexion_range"]["unit"] == "rad"
    assert float(of["knee_flexion_range"]["value_deg"]) == pytest.approx(math.degrees(1.0), rel=1e-6)
    assert (of["walking_speed"]["value"], of["walking_speed"]["withheld_because"]) == ("", "too few strides")
    assert "cadence: Two steps per stride time." in head
    assert (of["cadence"]["strides"], of["cadence"]["grade"], of["cadence"]["spread"]) == ("12", "good", "0.1")


def test_metrics_are_those_of_the_newest_message_alone(walk, made):
    older = made.some_metrics().model_copy(update={"metrics": [], "final": False})
    text = b"".join(csv_text("metrics", Facts(walk.description), [older, made.some_metrics()])).decode()
    assert text.count("steps/min") == 1


def test_curves_have_a_row_for_each_percent(walk):
    _, rows = table("curves", walk)
    assert [row["percent"] for row in rows] == [str(percent) for percent in range(101)]
    assert float(rows[0]["mean_deg"]) == pytest.approx(math.degrees(0.5), rel=1e-6)


def test_legs_are_compared_in_radians_and_degrees(walk):
    head, rows = table("sides", walk)
    assert (rows[0]["joint"], rows[0]["reference_side"], rows[0]["strides"]) == ("knee_flexion", "right", "11")
    assert float(rows[0]["rmse_deg"]) == pytest.approx(math.degrees(0.2), rel=1e-6)
    assert "knee_flexion_left: positive = shank backward" in head


def test_only_phases_that_have_ended_are_rows(walk):
    _, rows = table("phases", walk)
    assert [(row["phase"], row["end_s"], row["steps"]) for row in rows] == [("turn", "3.240000", "4")]


def test_ranges_of_a_repetition_are_named(walk):
    _, rows = table("repetitions", walk)
    assert rows[0]["ranges"] == "hip_flexion_left=0.50000"
    assert float(rows[0]["turn_angle_deg"]) == pytest.approx(math.degrees(1.5), rel=1e-6)


def test_a_table_without_a_message_is_a_head(about):
    text = b"".join(csv_text("strides", Facts(about), [])).decode()
    assert text.splitlines()[-1].startswith("side,index,start_s")
    assert "not known: no calibration" in text


def test_in_parts_it_is_the_same_file(walk):
    facts = facts_of(walk)
    whole = io.StringIO(newline="")
    file = CsvFile(whole, "joint_angles", facts)
    for payload in walk.payloads(TABLES["joint_angles"].signal):
        file.take(payload)
    file.close()
    parts = list(csv_text("joint_angles", facts, walk.payloads(TABLES["joint_angles"].signal)))
    assert b"".join(parts).decode() == whole.getvalue()


def test_conditions_that_nobody_said_are_not_there():
    assert conditions_in_words(UNSAID) == "nothing was said"
