import shutil
from importlib.metadata import version
from pathlib import Path

import pytest

from schemas.archive_layout import SegmentName, parse_file_name
from services.flow.software import DECISIVE, SOFTWARE, VERSION, digest_of_sources

ROOT = Path(__file__).parents[3]


@pytest.fixture
def tree(tmp_path):
    """Two decisive folders and one that decides nothing."""
    for name, text in {"schemas/a.py": "a", "services/flow/deep/b.py": "b", "services/cli/c.py": "c"}.items():
        path = tmp_path / "one" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path / "one"


def test_version_names_the_release_and_the_sources():
    release, _, digest = VERSION.partition("+")
    assert release == version("ambula")
    assert digest == digest_of_sources(ROOT)
    assert f"ambula {VERSION}" == SOFTWARE
    name = SegmentName("derived", VERSION, 0, part=False)
    assert parse_file_name(name.file_name) == name


def test_what_decides_numbers_is_there():
    assert [folder for folder in DECISIVE if not list((ROOT / folder).glob("*.py"))] == []


def test_the_same_sources_elsewhere_have_the_same_digest(tree):
    copy = shutil.copytree(tree, tree.parent / "two")
    (copy / "services/flow/__pycache__").mkdir()
    (copy / "services/flow/__pycache__/b.cpython-311.pyc").write_bytes(b"compiled")
    (copy / "services/flow/README.md").write_text("words")
    (copy / "services/cli/c.py").write_text("another screen")
    assert digest_of_sources(copy) == digest_of_sources(tree)


@pytest.mark.parametrize(
    "change",
    [
        lambda tree: (tree / "schemas/a.py").write_text("A"),
        lambda tree: (tree / "schemas/new.py").write_text(""),
        lambda tree: (tree / "services/flow/deep/b.py").unlink(),
        lambda tree: (tree / "services/flow/deep/b.py").rename(tree / "services/flow/b.py"),
        lambda tree: (tree / "schemas/a.py").rename(tree / "schemas/z.py"),
    ],
)
def test_any_change_of_what_decides_changes_it(tree, change):
    before = digest_of_sources(tree)
    change(tree)
    assert digest_of_sources(tree) != before
