"""The patient that every test of progress starts from."""

from types import SimpleNamespace

import pytest

from schemas.population import Population
from schemas.vocabulary import Side
from services.progress.baseline import freeze
from services.progress.progress import Person, progress
from tests.unit.progress import patient

PERSON = Person(Population.STROKE_CHRONIC, Side.LEFT, {})


def judged(visits, person=PERSON, baseline=None, session=None, measure="walking_speed", side=None):
    """The series of one measure, counted from a fresh baseline unless one is given."""
    frozen = baseline or freeze(visits, session, person.population, {})
    found = progress(visits, frozen, person).series
    return next(each for each in found if (each.measure, each.side) == (measure, side))


@pytest.fixture
def make():
    names = ("metric", "comparison", "curve", "results", "trial", "speeds", "said")
    return SimpleNamespace(judged=judged, person=PERSON, **{name: getattr(patient, name) for name in names})
