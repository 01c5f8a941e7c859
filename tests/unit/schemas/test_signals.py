from pathlib import Path

import pytest

from schemas.signals import SIGNALS, Quality, stream_key

SERVICES = Path(__file__).parents[3] / "services"


def processes():
    return {path.parent.name for path in SERVICES.glob("*/__main__.py")} - {"cli"}


@pytest.mark.parametrize("signal", SIGNALS, ids=lambda signal: signal.name)
def test_row_is_complete(signal):
    assert signal.name.islower()
    assert signal.meaning
    assert signal.producer in processes() | {"every service", "every node", "every consumer"}


def test_names_are_unique():
    assert len({signal.name for signal in SIGNALS}) == len(SIGNALS)


def test_what_is_archived_is_lossless_or_state():
    assert all(signal.quality is not Quality.LIVE for signal in SIGNALS if signal.archived)


def test_keys_carry_site_session_signal_and_source_only():
    imu = next(signal for signal in SIGNALS if signal.name == "imu")
    assert stream_key("ward", "3f", imu, "hub") == "ambula/ward/3f/imu/hub"
