"""A report as it is shown: typed, in one language, with its units. The web page and the PDF draw nothing else."""

from enum import StrEnum
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from schemas.metrics import TrustGrade
from schemas.vocabulary import Side


class Language(StrEnum):
    """Languages that there is a catalogue of."""

    ENGLISH = "en"
    FRENCH = "fr"


class Shown(BaseModel):
    """Base of everything shown: nothing but what is declared, and nothing left out."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Fact(Shown):
    """A label and what stands behind it."""

    label: str = Field(examples=["Walking aid"])
    text: str = Field(examples=["cane"])


class QualityLine(Shown):
    """How far the whole session may be relied on, in one line."""

    grade: TrustGrade | None = Field(description="null where nothing is known of the data", examples=["good"])
    head: str = Field(examples=["Data quality"])
    word: str = Field(description="the grade as a word, so that no colour carries it alone", examples=["Good"])
    title: str = Field(description="head and word as the language joins them", examples=["Data quality: Good"])
    text: str = Field(examples=["0.4 % of the samples lost; 38 of 42 strides used"])
    warnings: list[str] = Field(examples=[["The left thigh sensor was silent for 2.1 s."]])


class Header(Shown):
    """Who, when, which test, under which conditions."""

    title: str = Field(examples=["Gait report"])
    subtitle: str = Field(examples=["Six-minute walk, 22 November 2026"])
    facts: list[Fact]
    quality: QualityLine


class Tone(StrEnum):
    """How a text is set apart, beside what it says."""

    PLAIN = "plain"
    QUIET = "quiet"
    STRONG = "strong"
    WITHHELD = "withheld"


class Cell(Shown):
    """One field of a table."""

    text: str = Field(examples=["1.12 m/s"])
    note: str | None = Field(description="smaller, below the text: spread, trust, or why there is no number")
    tone: Tone = Field(examples=["plain"])
    span: int = Field(ge=1, description="number of columns it takes; a value of the whole body takes both sides'")


class Column(Shown):
    """Head of a column. A side's column bears its letter and its colour."""

    head: str = Field(examples=["Left"])
    side: Side | None = Field(examples=["left"])
    numeric: bool = Field(description="set to the right")


class Row(Shown):
    """One row: its head, then cells that take together as many columns as there are after the first."""

    head: str = Field(examples=["Walking speed"])
    note: str | None = Field(description="smaller, beside the head: a unit or a definition")
    cells: list[Cell]


class Table(Shown):
    """A table whose first column holds the heads of the rows."""

    caption: str = Field(description="what a screen reader says before the table")
    columns: list[Column] = Field(description="the first stands above the heads of the rows")
    rows: list[Row]


class Chart(Shown):
    """A drawing, the same on screen and on paper."""

    id: str = Field(description="unique within the report", examples=["curve-knee_flexion"])
    title: str = Field(examples=["Knee flexion"])
    svg: str = Field(description="a stand-alone SVG: no script, no style sheet, nothing from elsewhere")
    alt: str = Field(description="what the drawing shows, in words with its numbers")
    columns: Literal[1, 2, 3, 4, 6, 12] = Field(description="how many twelfths of a page's width it takes")


class SectionId(StrEnum):
    """Parts of a report, by what they answer. Which are there depends on the test."""

    SUMMARY = "summary"
    TIME_DISTANCE = "time_distance"
    TEST = "test"
    PHASES = "phases"
    REPETITIONS = "repetitions"
    CURVES = "curves"
    KEY_POINTS = "key_points"
    SYMMETRY = "symmetry"
    PROGRESS = "progress"
    CURVE_DISTANCE = "curve_distance"
    SIDES = "sides"
    LIMITS = "limits"
    CONSISTENCY = "consistency"


class Section(Shown):
    """One part under its heading: sentences, then charts, then a table, then notes. Any of them may be missing."""

    id: SectionId
    page: Literal[1, 2, 3] = Field(description="1 for therapist and patient, 2 for specialists, 3 on request")
    title: str = Field(examples=["Summary"])
    sentences: list[str]
    charts: list[Chart]
    table: Table | None
    notes: list[str] = Field(description="small print: formulae, sources, what is missing and why")


class Footer(Shown):
    """What every page bears."""

    items: list[str] = Field(description="code, visit, report id, software, references, hash of the recording")
    disclaimer: str = Field(examples=["Not for diagnosis"])
    page: str = Field(description="with {page} and {pages}", examples=["Page {page} of {pages}"])


class Report(Shown):
    """A whole report in one language."""

    id: str = Field(description="changes with every value shown", examples=["R-3F9A-71C2"])
    language: Language
    session: str = Field(description="session id", examples=["8d0c2a71f04be655"])
    made_for: str = Field(description="date of the session, ISO 8601", examples=["2026-11-22"])
    header: Header
    sections: list[Section] = Field(description="in the order in which they are read")
    footer: Footer
