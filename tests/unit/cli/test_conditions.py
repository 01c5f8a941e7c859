"""How a test was done, as it is written on a command line."""

import json

import pytest
from typer.testing import CliRunner

from schemas.conditions import UNSAID, SpeedInstruction, WalkingAid
from schemas.vocabulary import Side
from services.cli.__main__ import app
from services.cli.conditions import read_conditions


def test_nothing_said_leaves_it_to_the_source() -> None:
    assert read_conditions(None) is None


def test_short_words_and_a_zone() -> None:
    said = read_conditions("aid=cane&paretic=left&zone=2-8&duration=120&instruction=fast&physical_assistance=false")
    assert said == UNSAID.model_copy(
        update={
            "aid": WalkingAid.CANE, "paretic_side": Side.LEFT, "timed_from_m": 2.0, "timed_to_m": 8.0,
            "test_duration_s": 120.0, "speed_instruction": SpeedInstruction.FAST, "physical_assistance": False,
        }
    )  # fmt: skip


def test_a_file_says_the_same(tmp_path) -> None:
    alone, manifest = tmp_path / "how.toml", tmp_path / "recording.toml"
    alone.write_text('aid = "cane"\nzone = "2-12"\n')
    manifest.write_text('title = "x"\n[conditions]\naid = "cane"\ntimed_from_m = 2\ntimed_to_m = 12\n')
    assert read_conditions(str(alone)) == read_conditions(str(manifest))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("stick=1", "'stick' is unknown; there are aid"),
        ("aid=stick", "Input should be 'none', 'cane'"),
        ("zone=8", "write zone=2-8"),
        ("zone=a-b", "timed_from_m"),
        ("duration=-3", "greater than 0"),
        ("aid=cane&&", "is no list"),
        ("nowhere.toml", "cannot be read"),
    ],
)
def test_what_cannot_be_is_refused_with_what_can(text: str, says: str) -> None:
    with pytest.raises(ValueError, match="--conditions") as refused:
        read_conditions(text)
    assert says in str(refused.value)


def test_a_file_that_is_none(tmp_path) -> None:
    (tmp_path / "how.toml").write_text("aid is cane")
    with pytest.raises(ValueError, match="is not TOML"):
        read_conditions(str(tmp_path / "how.toml"))


def test_run_takes_them_and_stores_them_with_the_result(tmp_path) -> None:
    asked = ["run", "synthetic:walk?duration=8", "--out", str(tmp_path), "--conditions", "aid=cane", "--walkway", "10"]
    done = CliRunner().invoke(app, asked)
    assert done.exit_code == 0, done.output
    told = json.loads((tmp_path / "metrics.json").read_text())
    assert (told["conditions"], told["walkway_m"]) == ({"aid": "cane"}, 10.0)


def test_run_says_what_is_wrong(tmp_path) -> None:
    done = CliRunner().invoke(app, ["run", "synthetic:walk", "--out", str(tmp_path), "--conditions", "aid=stick"])
    assert done.exit_code == 1
    assert "aid" in done.output
