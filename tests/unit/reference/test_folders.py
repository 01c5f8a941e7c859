import pytest

from services.definitions.table import BY_NAME
from services.reference.errors import ReferenceSetError
from services.reference.folders import SHIPPED, own_folders, read_set, read_shelf
from services.reference.sets import SetKind
from tests.unit.reference.folder import HEADER, ROWS, write_set

CURVE = [f"knee_flexion,{k},0.5,0.1" for k in range(101)]


def test_a_set_is_read_with_its_curves(tmp_path):
    found = read_set(write_set(tmp_path, curves=CURVE), own=True)
    assert (found.manifest.n, found.manifest.version, len(found.strata)) == (24, "3", 4)
    assert found.measures == {"walking_speed", "step_length", "knee_flexion_range"}
    assert len(found.curves["knee_flexion"].mean) == 101


@pytest.mark.parametrize(
    ("rows", "line", "what"),
    [
        (["walking_speed,cm/s,,,,,,,130,15,,,,"], "line 2", "unit"),
        (["walking_speed,m/s,,,,,,,1.3,0.1,,,,", "x,m,woman,,,,,,1,1,,,,"], "line 3", "sex"),
        (["x,m,,40,20,,,,1,1,,,,"], "line 2", "from_age is larger"),
        (["x,m,,,,,,,nan,1,,,,"], "line 2", "not finite"),
        (["x,m,,,,,,,1,much,,,,"], "line 2", "not a number"),
        (["x,m,,,,,,2.5,1,1,,,,"], "line 2", "number of people"),
        (["x,m,,,,,,,,,,,,"], "line 2", "neither a mean nor both limits"),
        (["x,m,,,,,,,1,0,,,,"], "line 2", "sd must be positive"),
        (["x,m,,,,,,,1,1,,,1.2,0.3"], "line 2", "line over speed"),
        ([",m,,,,,,,1,1,,,,"], "line 2", "measure is empty"),
    ],
)
def test_a_row_that_is_wrong_is_named_by_its_line(tmp_path, rows, line, what):
    with pytest.raises(ReferenceSetError, match=what) as caught:
        read_set(write_set(tmp_path, rows), own=True)
    assert line in caught.value.where


@pytest.mark.parametrize(
    ("changes", "what"),
    [
        ({"licence": None}, "licence"), ({"kind": "advert"}, "kind"), ({"datum": None}, "datum"), ({"n": 0}, "n"),
        ({"header": HEADER + ",name"}, "unknown column 'name'"), ({"header": "unit,mean", "rows": ["m,1"]}, "measure"),
        ({"rows": []}, "no rows"), ({"curves": CURVE[:50]}, "50 rows"), ({"curves": CURVE[1:]}, "0 % should follow"),
        ({"curves": ["knee_flexion,0,high,0.1"]}, "numbers"),
        ({"kind": "plausibility"}, "low and high"),
    ],
)  # fmt: skip
def test_a_set_that_is_wrong_says_what(tmp_path, changes, what):
    with pytest.raises(ReferenceSetError, match=what):
        read_set(write_set(tmp_path, **changes), own=True)


def test_names_and_missing_files(tmp_path):
    folder = write_set(tmp_path)
    folder.rename(tmp_path / "renamed")
    with pytest.raises(ReferenceSetError, match="name it as the folder"):
        read_set(tmp_path / "renamed", own=True)
    (tmp_path / "renamed" / "manifest.toml").write_text("name = ")
    with pytest.raises(ReferenceSetError, match=r"manifest\.toml"):
        read_set(tmp_path / "renamed", own=True)
    with pytest.raises(ReferenceSetError, match="is missing"):
        read_set(tmp_path / "nowhere", own=True)


def test_a_bad_folder_takes_nothing_else_away(tmp_path):
    write_set(tmp_path / "own")
    write_set(tmp_path / "own", ["x,cm,,,,,,,1,1,,,,"], name="spoiled")
    write_set(tmp_path / "other")
    shelf = read_shelf(own_folders(f"{tmp_path / 'own'}:{tmp_path / 'other'}:{tmp_path / 'absent'}"))
    assert shelf.sets[0].manifest.name == "clinic"
    assert shelf.named("clinic").own
    assert not shelf.named("mobbs_2025").own
    assert {(error.folder, error.where) for error in shelf.refused} == {
        ("spoiled", "table.csv: line 2"), ("clinic", "manifest.toml"), ("absent", "manifest.toml"),
    }  # fmt: skip


def test_what_is_shipped_is_whole_and_fits_the_definitions():
    shelf = read_shelf([])
    assert shelf.refused == ()
    assert {each.manifest.name for each in shelf.sets} == {path.name for path in SHIPPED.iterdir()}
    for each in shelf.sets:
        for stratum in each.strata:
            assert BY_NAME[stratum.measure].unit == stratum.unit
    assert shelf.named("mobgap_limits").manifest.kind is SetKind.PLAUSIBILITY
    assert len(ROWS) == 4
