from types import SimpleNamespace

import pytest

from services.report.press import Press
from tests.unit.report import made as makers


@pytest.fixture
def made() -> SimpleNamespace:
    """Makers of made-up sessions."""
    return SimpleNamespace(**{name: value for name, value in vars(makers).items() if not name.startswith("_")})


@pytest.fixture(scope="session")
def press() -> Press:
    return Press()
