"""Units, axes, orders and the manifests that come with the software."""

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from services.ingest.axes import rotation_from_axes
from services.ingest.data import MANIFESTS, find_data, find_data_root
from services.ingest.errors import InvalidManifest, MissingFile, UnknownUnit
from services.ingest.identity import Identity
from services.ingest.manifest import load_manifest
from services.ingest.orders import InvalidOrder, StartOrder, StopOrder, parse_order, refusal
from services.ingest.units import reference_unit, scale_to_si


@pytest.mark.parametrize(
    ("quantity", "unit", "factor"),
    [
        ("specific force", "g", 9.80665),
        ("specific force", "mg", 0.00980665),
        ("angular velocity", "deg/s", math.pi / 180),
        ("time", "us", 1e-6),
        ("length", "mm", 1e-3),
    ],
)
def test_units(quantity, unit, factor):
    assert scale_to_si(quantity, unit) == pytest.approx(factor)


def test_unknown_units_name_the_known_ones():
    with pytest.raises(UnknownUnit, match="rad/s, deg/s"):
        scale_to_si("angular velocity", "rpm")
    assert reference_unit("deg") == (pytest.approx(math.pi / 180), "rad")


def test_axes_as_letters_and_as_rows():
    letters = rotation_from_axes(["x", "z", "-y"], "here")
    assert letters @ [1, 2, 3] == pytest.approx([1, 3, -2])
    rows = rotation_from_axes([[1, 0, 0], [0, 0, 1], [0, -1, 0]], "here")
    assert (rows == letters).all()
    assert (rotation_from_axes(None, "here") == np.eye(3)).all()


@pytest.mark.parametrize("axes", [["x", "y"], ["x", "x", "z"], ["x", "y", "-z"], ["--x", "y", "z"], [[1, 0], [0, 1]]])
def test_axes_that_are_no_rotation(axes):
    with pytest.raises(InvalidManifest, match="here"):
        rotation_from_axes(axes, "here")


@pytest.mark.parametrize("path", sorted(MANIFESTS.glob("*.toml")), ids=lambda path: path.stem)
def test_shipped_manifests_are_right(path):
    manifest = load_manifest(path)
    assert manifest.title
    assert manifest.data != "."


def test_data_is_found_by_the_environment_first(tmp_path, monkeypatch):
    (tmp_path / "walk").mkdir()
    monkeypatch.setenv("AMBULA_DATA", str(tmp_path))
    assert find_data("walk") == tmp_path / "walk"
    assert find_data_root() == tmp_path
    with pytest.raises(MissingFile, match="AMBULA_DATA"):
        find_data("run")


def test_sessions_get_random_ids():
    assert Identity.new().session != Identity.new().session


@given(st.one_of(st.binary(max_size=200), st.text(max_size=200).map(str.encode)))
def test_any_order_is_understood_or_refused(body):
    for model in (StartOrder, StopOrder):
        try:
            parse_order(model, body)
        except InvalidOrder as error:
            answer = refusal(error)
        else:
            continue
        assert json.loads(answer)["error"]


@pytest.mark.parametrize(
    "body", [b'{"source": "x"}', b'{"source": "x", "speed": 0}', b'{"source": "", "speed": 1}', b"[]", b'{"speed": 1}']
)
def test_incomplete_orders_are_refused(body):
    with pytest.raises(InvalidOrder):
        parse_order(StartOrder, body)


def test_an_order_with_fields_of_a_newer_sender():
    order = parse_order(StartOrder, b'{"source": "x", "speed": null, "colour": "red"}')
    assert (order.source, order.speed, order.ticks) == ("x", None, 1)
