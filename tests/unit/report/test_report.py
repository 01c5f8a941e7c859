import pytest

from schemas.metrics import DoubtKind
from schemas.vocabulary import Side, Task
from services.progress.rules import RuleCode, Verdict, rule
from services.report.assemble import make_report
from services.report.content import Language, Report, SectionId

WALK_ORDER = [
    "summary",
    "time_distance",
    "curves",
    "key_points",
    "symmetry",
    "sides",
    "progress",
    "curve_distance",
    "limits",
]


def section(report: Report, name: SectionId):
    return next(each for each in report.sections if each.id == name)


def texts(report: Report, name: SectionId) -> str:
    part = section(report, name)
    rows = [] if part.table is None else part.table.rows
    cells = [text for row in rows for text in (row.head, *(f"{cell.text} {cell.note}" for cell in row.cells))]
    return " ".join([*part.sentences, *cells, *part.notes]).replace("\u00a0", " ")


def row(report: Report, name: SectionId, head: str):
    table = section(report, name).table
    return next(each for each in table.rows if each.head == head)


def test_a_walk_has_all_sections_in_their_order(made):
    report = make_report(made.source(progress=made.progress()), Language.ENGLISH)
    assert [each.id for each in report.sections] == WALK_ORDER
    assert [each.page for each in report.sections] == sorted(each.page for each in report.sections)


def test_every_sentence_of_the_summary_contains_a_number(made):
    for given in (made.source(), made.source(progress=made.progress()), made.unsaid()):
        for language in Language:
            sentences = section(make_report(given, language), SectionId.SUMMARY).sentences
            assert sentences
            assert all(any(letter.isdigit() for letter in sentence) for sentence in sentences)


def test_columns_are_those_of_the_conventions(made):
    given = made.source(progress=made.progress(), references=(made.speed_reference(),))
    table = section(make_report(given, Language.ENGLISH), SectionId.TIME_DISTANCE).table
    heads = [column.head for column in table.columns]
    assert heads == ["Measure", "Left", "Right", "Reference", "Against reference", "Change since baseline", "MDC"]
    for each in table.rows:
        assert sum(cell.span for cell in each.cells) == len(table.columns) - 1


@pytest.mark.parametrize(("low", "high", "word"), [(1.0, 1.5, "below"), (0.5, 1.0, "within"), (0.2, 0.5, "above")])
def test_a_value_is_below_within_or_above_its_reference(made, low, high, word):
    report = make_report(made.source(references=(made.speed_reference(low, high),)), Language.ENGLISH)
    speed = row(report, SectionId.TIME_DISTANCE, "Walking speed")
    assert [cell.text for cell in speed.cells] == ["0.76\u00a0± 0.04", f"{low:.2f} to {high:.2f}", word]
    assert f"is {word} reference" in texts(report, SectionId.SUMMARY)


def test_without_a_reference_a_sentence_says_so(made):
    report = make_report(made.source(), Language.ENGLISH)
    assert "No reference set fits" in texts(report, SectionId.TIME_DISTANCE)
    assert "No grey reference band" in texts(report, SectionId.CURVES)


@pytest.mark.parametrize(
    ("verdict", "words"),
    [
        (Verdict.REAL_CHANGE, "real change"),
        (Verdict.WITHIN_MEASUREMENT_ERROR, "within measurement error"),
        (Verdict.CANNOT_TELL, "cannot tell"),
    ],
)
def test_a_change_bears_its_verdict_in_words(made, verdict, words):
    report = make_report(made.source(progress=made.progress(made.measure(verdict=verdict))), Language.ENGLISH)
    speed = row(report, SectionId.TIME_DISTANCE, "Walking speed")
    assert ("+0.26", words) in [(cell.text, cell.note) for cell in speed.cells]
    assert words in texts(report, SectionId.SUMMARY)
    assert "Lewek 2019" in texts(report, SectionId.TIME_DISTANCE)


def test_a_withheld_metric_gives_its_reason_and_no_number(made):
    report = make_report(made.source(), Language.ENGLISH)
    assert [cell.text for cell in row(report, SectionId.TIME_DISTANCE, "Stride time, variation").cells] == ["–"]
    assert "4 cycles, 10 needed" in texts(report, SectionId.LIMITS)
    assert "1 value is withheld" in texts(report, SectionId.SUMMARY)


def test_trust_stands_beside_a_number_as_a_word(made):
    report = make_report(made.source(), Language.ENGLISH)
    assert row(report, SectionId.TIME_DISTANCE, "Double support").cells[0].note == "poor"


def test_what_was_left_out_is_counted(made):
    said = texts(make_report(made.source(), Language.ENGLISH), SectionId.LIMITS)
    assert "2 with something wrong about them, 4 in turns, 4 at the start or end" in said
    assert "step width" in said


def test_the_formula_of_symmetry_is_printed(made):
    assert "paretic / non-paretic" in texts(make_report(made.source(), Language.ENGLISH), SectionId.SYMMETRY)
    plain = made.session_metrics(made.metric("step_length_ratio_larger_to_smaller", 1.2, "1"))
    assert "larger / smaller" in texts(make_report(made.source(metrics=plain), Language.ENGLISH), SectionId.SYMMETRY)


def test_recovery_is_told_with_its_reason(made):
    said = texts(make_report(made.source(progress=made.progress()), Language.ENGLISH), SectionId.SIDES)
    assert "Knee flexion: recovery. Speed rose by +0.26 m/s and the legs’ curves came closer by −2.9°." in said


def test_the_footer_says_what_it_must(made):
    footer = make_report(made.source(progress=made.progress()), Language.ENGLISH).footer
    said = " ".join(footer.items)
    for part in (
        "K7QM3F",
        "visit 3",
        "R-",
        "ambula 0.1.0+0a1b2c3d",
        "rhythmic_ekf",
        "mobbs_2025 1",
        "0123456789abcdef",
    ):
        assert part in said
    assert "Not for diagnosis" in footer.disclaimer
    assert footer.page == "Page {page} of {pages}"


def test_nothing_said_is_said_so(made):
    report = make_report(made.unsaid(), Language.ENGLISH)
    facts = {fact.label: fact.text for fact in report.header.facts}
    assert facts["Code"] == "not assigned"
    assert facts["Walking aid"] == "not said"
    assert "recording sha256" in " ".join(report.footer.items)


def test_the_same_values_give_the_same_report_and_others_another_id(made):
    first, second = (make_report(made.source(), Language.ENGLISH) for _ in range(2))
    assert first == second
    changed = made.source(metrics=made.session_metrics(*made.walk_metrics(speed=0.77)))
    assert make_report(changed, Language.ENGLISH).id != first.id


def test_numbers_are_written_as_the_language_does(made):
    french = make_report(made.source(), Language.FRENCH)
    assert "0,76 m/s" in texts(french, SectionId.SUMMARY)
    assert "0.76" not in texts(french, SectionId.TIME_DISTANCE)


def test_a_timed_up_and_go_has_its_phases(made):
    metrics = [made.metric("tug_time", 10.5, "s", strides=1), made.metric("tug_turn_time", 2.1, "s", strides=1)]
    given = made.source(
        description=made.described(task=Task.TIMED_UP_AND_GO, walkway_m=3.0),
        metrics=made.session_metrics(*metrics, phases=made.tug_phases(), curves=[], sides=[]),
    )
    report = make_report(given, Language.ENGLISH)
    assert [each.id for each in report.sections] == ["summary", "test", "limits"]
    assert "rising 2.10 s" in section(report, SectionId.TEST).charts[0].alt.replace("\u00a0", " ")
    assert "10.50 s" in texts(report, SectionId.SUMMARY)
    assert report.header.subtitle == "Timed up and go, 9 November 2026"


def test_an_exercise_shows_every_repetition_and_why_one_does_not_count(made):
    metrics = [
        made.metric("repetitions_counted", 4.0, "1", Side.LEFT),
        made.metric("repetitions_rejected", 1.0, "1", Side.LEFT),
        made.metric("repetition_range", 1.4, "rad", Side.LEFT, strides=4),
    ]
    given = made.source(
        description=made.described(task=Task.KNEE_FLEXION),
        metrics=made.session_metrics(*metrics, repetitions=made.knee_repetitions(), curves=[], sides=[]),
    )
    report = make_report(given, Language.ENGLISH)
    assert [each.id for each in report.sections] == ["summary", "repetitions", "limits"]
    assert section(report, SectionId.REPETITIONS).charts[0].svg.count('fill="#FFFFFF"') == 1
    assert "samples are missing (1)" in texts(report, SectionId.LIMITS)
    assert "4 of 5 repetitions used" in report.header.quality.text


def test_a_six_minute_walk_shows_speed_by_minute_and_not_as_rows(made):
    names = ("first", "second", "third")
    minutes = [made.metric(f"six_minute_walk_speed_{name}_minute", 0.8, "m/s") for name in names]
    metrics = [made.metric("six_minute_walk_distance", 287.4, "m"), *minutes]
    given = made.source(
        description=made.described(task=Task.SIX_MINUTE_WALK, walkway_m=30.0),
        metrics=made.session_metrics(*metrics, curves=[], sides=[]),
    )
    report = make_report(given, Language.ENGLISH)
    assert "287 m were walked in 6 min." in texts(report, SectionId.SUMMARY)
    test = section(report, SectionId.TEST)
    assert [chart.id for chart in test.charts] == ["minutes"]
    assert [each.head for each in test.table.rows] == ["Distance"]


def test_no_value_at_all_is_said_with_the_reason(made):
    silent = made.metric("walking_speed", None, "m/s", strides=1, doubts=[made.Doubt(
        kind=DoubtKind.FEW_CYCLES, value=1.0, limit=3.0, subject=None)])  # fmt: skip
    report = make_report(made.source(metrics=made.session_metrics(silent, curves=[], sides=[])), Language.ENGLISH)
    assert texts(report, SectionId.SUMMARY).startswith("0 values can be given for this session: 1 cycles, 3 needed")


def test_of_the_baseline_visit_no_change_is_told(made):
    given = made.progress(visit=1, baseline_visit=1)
    report = make_report(made.source(progress=given), Language.ENGLISH)
    assert "This visit is the baseline" in texts(report, SectionId.TIME_DISTANCE)
    assert "Change since baseline" not in [c.head for c in section(report, SectionId.TIME_DISTANCE).table.columns]


def test_why_there_is_no_threshold_is_said(made):
    history = made.measure(verdict=Verdict.CANNOT_TELL, mdc=0.15)
    why = (rule(RuleCode.POPULATION_UNSAID),)
    history = made.MeasureProgress(
        history.metric, None, history.unit, history.visits, history.baseline, None, None, None, why
    )
    said = texts(make_report(made.source(progress=made.progress(history)), Language.ENGLISH), SectionId.TIME_DISTANCE)
    assert "Nobody said which group of patients" in said
