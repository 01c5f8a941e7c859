import string
import tomllib
from importlib.resources import files

import pytest

from schemas.conditions import Footwear, Orthosis, SpeedInstruction, WalkingAid
from schemas.metrics import DoubtKind, TrustGrade
from schemas.population import Population
from schemas.vocabulary import Segment, Task, TaskPhaseKind
from services.definitions.table import DEFINITIONS
from services.progress.recovery import OTHER_MOTIONS
from services.progress.rules import RULES, JointWord, RuleCode, Verdict
from services.progress.thresholds import THRESHOLDS
from services.progress.treatments import TreatmentKind
from services.reference.bands import NoBand
from services.report.catalogue import MINUS, NO_BREAK, MissingWord, catalogue
from services.report.content import Language

ENGLISH = catalogue(Language.ENGLISH)
FORBIDDEN = ("normal", "abnormal", "anormal", "pathologi")


def placeholders(text: str) -> set[str]:
    return {name for _, name, _, _ in string.Formatter().parse(text) if name}


@pytest.mark.parametrize("language", Language)
def test_every_language_has_the_same_keys_and_placeholders(language):
    words = catalogue(language)
    assert words.messages.keys() == ENGLISH.messages.keys()
    for key, text in ENGLISH.messages.items():
        assert placeholders(words.messages[key]) == placeholders(text), key


@pytest.mark.parametrize("language", Language)
def test_no_word_calls_a_person_normal_or_not(language):
    said = " ".join(catalogue(language).messages.values()).lower()
    assert not [word for word in FORBIDDEN if word in said]


@pytest.mark.parametrize("language", Language)
def test_every_word_of_the_contract_can_be_said(language):
    words = catalogue(language)
    kinds = {
        "aid": WalkingAid, "orthosis": Orthosis, "footwear": Footwear, "speed": SpeedInstruction, "task": Task,
        "phase": TaskPhaseKind, "segment": Segment, "grade": TrustGrade, "verdict": Verdict, "treatment": TreatmentKind,
        "population": Population, "joint_word": JointWord, "motion": OTHER_MOTIONS,
    }  # fmt: skip
    missing = [f"{kind}.{word}" for kind, values in kinds.items() for word in values if not words.has(f"{kind}.{word}")]
    missing += [kind for kind in DoubtKind if not words.has(f"doubt.{kind}_plain")]
    missing += [gap for gap in NoBand if gap is not NoBand.UNIT_DIFFERS and not words.has(f"reference.gap_{gap}")]
    missing += [row.people for row in THRESHOLDS if not words.has(f"people.{row.people}")]
    assert missing == []


@pytest.mark.parametrize("language", Language)
@pytest.mark.parametrize("code", RuleCode)
def test_a_rule_takes_the_parameters_that_it_has(language, code):
    assert placeholders(catalogue(language).messages[f"rule.{code}"]) <= set(RULES[code])


@pytest.mark.parametrize("language", Language)
def test_every_metric_that_a_page_shows_has_a_name(language):
    words = catalogue(language)
    unnamed = [
        one.name for one in DEFINITIONS if not one.export_only and words.metric(one.name) == one.name.replace("_", " ")
    ]
    assert unnamed == []


def test_a_number_has_the_mark_of_its_language_and_a_true_minus():
    french = catalogue(Language.FRENCH)
    assert french.number(-1.25, 2) == f"{MINUS}1,25"
    assert ENGLISH.number(1234.5, 1) == "1234.5"
    assert ENGLISH.number(-0.001, 2, signed=True) == "0.00"
    assert ENGLISH.number(0.3, 1, signed=True) == "+0.3"
    assert ENGLISH.number(None, 2) == "–"


def test_french_counts_nothing_as_one():
    assert catalogue(Language.FRENCH).one_or_more("summary.rests", 0) == "Il y a eu 0 pause."
    assert ENGLISH.one_or_more("summary.rests", 0) == "There were 0 rests."


def test_marks_stay_on_the_line_of_their_word():
    assert f"{NO_BREAK}: " in catalogue(Language.FRENCH).text("format.colon", label="Vitesse", text="1")


def test_an_unknown_key_is_a_bug_and_named():
    with pytest.raises(MissingWord, match=r"no\.such"):
        ENGLISH.text("no.such")


@pytest.mark.parametrize("language", Language)
def test_every_message_is_text(language):
    raw = tomllib.loads(files("services.report.wording").joinpath(f"{language}.toml").read_text(encoding="utf-8"))
    assert all(isinstance(table, dict) for table in raw.values())
    assert all(isinstance(text, str) and text for text in catalogue(language).messages.values())
