"""The virtual participants in the report and on the terminal."""

from collections.abc import Mapping, Sequence

import numpy as np

from services.bench.joukov.marching import (
    BEAT,
    ESTIMATORS,
    LITERAL,
    MODELS,
    OURS,
    OWN_PACE,
    PLAIN,
    TITLES,
    TRIALS,
    Score,
    Scores,
    Setting,
    Tuning,
)
from services.bench.joukov.marching_charts import Example, charts
from services.bench.joukov.marching_tables import (
    PUBLISHED_ACCELERATION,
    PUBLISHED_FREQUENCY_PERCENT,
    PUBLISHED_SEGMENTED_PERCENT,
    PUBLISHED_VELOCITY,
    Trials,
    absolute_table,
    best_ratio,
    curve,
    curve_table,
    frequency_error,
    frequency_table,
    largest_S,
    mean_ratio,
    people_of,
    segmentation_table,
    segmented_percent,
)
from services.bench.joukov.published_tables import error_table, prediction_table
from services.bench.joukov.regions import BOTTOM, QUANTITIES, QUARTER, REGIONS, TOP, WHOLE
from services.bench.joukov.sections import Finding, Section, change, power, up_to
from services.bench.scoreboard import Row, at_least, at_most, informative

MODEL_WORDS = {"gravity": "accelerometers see gravity alone", "published": "published measurement model"}
WANTED = {1: PUBLISHED_VELOCITY, 2: PUBLISHED_ACCELERATION}
"""Published ratio by quantity."""


def marching_section(trials: Trials, tuning: Tuning, example: Example) -> Section:
    """Everything about the march."""
    people, named = people_of(trials), tuning.named
    tables = [frequency_table(trials, "S*", tuning.star)]
    for region in (TOP, BOTTOM):
        tables += [error_table(people, "gravity", at, S, region) for at, S in named.items()]
    tables += [error_table(people, "gravity", "S*", tuning.star, QUARTER)]
    tables += [
        error_table(people, "published", f"S*, {MODEL_WORDS['published']}", tuning.star, region)
        for region in (TOP, BOTTOM)
    ]
    tables += [prediction_table(people, {m: MODEL_WORDS[m] for m in MODELS}, at, S) for at, S in named.items()]
    tables += [segmentation_table(trials, tuning), curve_table(people), absolute_table(people)]
    return Section(
        "Marching on the spot: tables I to IV, segmentation",
        _paragraphs(len(people), tuning),
        _rows(trials, tuning),
        tables,
        charts(people, example),
        _findings(trials, tuning),
    )


def _findings(trials: Trials, tuning: Tuning) -> list[Finding]:
    """What the paper claims for its participants."""
    people, named = people_of(trials), tuning.named
    found = []
    for q, wanted in WANTED.items():
        here, where = [], []
        for e in (OURS, LITERAL):
            ratios = {at: float(mean_ratio(people, Setting("gravity", e, S))[q]) for at, S in named.items()}
            here.append(f"{TITLES[e]} " + ", ".join(f"{change(ratio)} at {at}" for at, ratio in ratios.items()))
            where.append(f"{TITLES[e]}: {up_to(largest_S(curve(people, e)[:, q], wanted))}")
        found.append(Finding(f"marching, {QUANTITIES[q]} {change(wanted)}", "; ".join(here), "; ".join(where)))
    beat = {
        e: max(abs(frequency_error(s[Setting("gravity", e, tuning.star)])) for s in trials[BEAT].values())
        for e in (OURS, LITERAL)
    }
    words = "; ".join(f"{TITLES[e]} at most {error:.2f} %" for e, error in beat.items())
    found.append(Finding("marching, frequency within 0.18, 0.30 and 1.08 %", words, "S*"))
    for trial in TRIALS:
        right = {
            e: segmented_percent([s[Setting("gravity", e, tuning.star)] for s in trials[trial].values()])
            for e in (OURS, LITERAL)
        }
        words = "; ".join(f"{TITLES[e]} {share:.1f} %" for e, share in right.items())
        found.append(Finding(f"marching, segmentation 96 %, {trial}", words, "S*"))
    return [*found, _prediction_finding(people, tuning)]


def _prediction_finding(people: Mapping[str, Scores], tuning: Tuning) -> Finding:
    parts = []
    for model in ("gravity", "published"):
        by = {e: _prediction([s[Setting(model, e, tuning.star)] for s in people.values()]) for e in ESTIMATORS}
        for e in (OURS, LITERAL):
            gyro, accel = (float(np.mean(by[e][kind] / by[PLAIN][kind])) for kind in range(2))
            parts.append(f"{TITLES[e]} {change(gyro)} and {change(accel)} ({MODEL_WORDS[model]})")
    return Finding("marching, next sample: gyroscope -42 %, accelerometer -15 %", "; ".join(parts), "S*")


def _paragraphs(people: int, tuning: Tuning) -> list[str]:
    named = ", ".join(f"{at} = {power(S)}" for at, S in tuning.named.items())
    return [
        f"{people} virtual participants march on the spot as the paper's three did (section IV-B): two minutes, five "
        "sensors, 50 Hz, at their own pace, after a metronome at 70 per minute, and after one that changes every 30 s. "
        "How high and how fast each marches, how the sensors sit and what their biases are is drawn from a seed; soft "
        "tissue turns the thigh sensors by 2 deg and the shank sensors by 0.8; noise 0.05 rad/s and 0.2 m/s². Truth is "
        "exact, with its derivatives. The paper's 70 steps per minute are 1.167 Hz of the right knee, so a beat is one "
        "cycle of a leg. Scored from 15 s after the start of the march, as published.",
        "Everything passes the calibration of the live service and the 15-dof filter. **Literal**: the Rhythmic-EKF of "
        "equations 15 to 21 as printed, with 7 harmonics, rates 0.7 and 0.05 per second, started at 5 rad/s. **Ours**: "
        "the Rhythmic-EKF with the rhythm that has to prove its lock. All three have our measurement model, in which "
        "accelerometers see gravity alone; in the tables with the published one they have the full Jacobian, dynamic "
        "accelerometers, hinge knees and yaw against the world instead.",
        f"Process noise S, as variance of the jerk per 10 ms sample: {named}, (rad/s³)². S* is the smallest S of half "
        "decades whose angles (without their mean error) are within 1 % of the plain filter's best, found on one more "
        "participant who is not scored; the paper tuned its EKF on its first participant and scored him as well. On "
        f"him the plain filter's accelerations are best at S = {power(tuning.agile)} and ours at "
        f"{power(tuning.agile_ours)}.",
        "Tables II and III follow the paper's text: the top region is where the true acceleration exceeds 75 % of its "
        "maximum. Stars: smaller than the EKF's in a one-sided Wilcoxon test, paired over the participants, at 5 % "
        "(the paper tested single errors, which are not independent). In the paper some SD exceed their RMSE, which "
        "no set of errors can do; here the SD is that of the same errors without their mean.",
    ]


def _rows(trials: Trials, tuning: Tuning) -> list[Row]:
    people = people_of(trials)
    rows: list[Row] = []
    for at, S in tuning.named.items():
        rows += [_frequency_row(trials, at, S), *_segmentation_rows(trials, at, S)]
    for at, S in tuning.named.items():
        rows += _ratio_rows(people, at, S)
    best = best_ratio(people, tuning)
    for q, quantity in enumerate(QUANTITIES):
        rows.append(
            informative(f"marching, each at its own best S: {quantity}", float(best[q]), "of plain", detail=q < 2)
        )
    rows += _which_S_rows(people)
    for at, S in tuning.named.items():
        rows += _prediction_rows(people, at, S)
    return rows


def _frequency_row(trials: Trials, at: str, S: float) -> Row:
    worst = {
        e: max(abs(frequency_error(s[Setting("gravity", e, S)])) for s in trials[BEAT].values())
        for e in (OURS, LITERAL)
    }
    title = f"marching at {at}: frequency after 15 s, largest error"
    return at_most(title, worst[OURS], "%", max(PUBLISHED_FREQUENCY_PERCENT), worst[LITERAL])


def _segmentation_rows(trials: Trials, at: str, S: float) -> list[Row]:
    rows = []
    for trial in TRIALS:
        share = {
            e: segmented_percent([s[Setting("gravity", e, S)] for s in trials[trial].values()]) for e in (OURS, LITERAL)
        }
        title = f"marching at {at}, {trial}: repetitions segmented right"
        if trial == OWN_PACE:
            rows.append(at_least(title, share[OURS], "%", min(PUBLISHED_SEGMENTED_PERCENT), share[LITERAL]))
        else:
            rows.append(informative(title, share[OURS], "%", share[LITERAL], detail=at != "S*"))
    return rows


def _ratio_rows(people: Mapping[str, Scores], at: str, S: float) -> list[Row]:
    rows = []
    for region in (WHOLE, TOP, BOTTOM):
        ours, literal = (mean_ratio(people, Setting("gravity", e, S), region) for e in (OURS, LITERAL))
        for q, quantity in enumerate(QUANTITIES):
            title, value, theirs = f"marching at {at}, {REGIONS[region]}: {quantity}", float(ours[q]), float(literal[q])
            if region == WHOLE and q in WANTED and at == "S*/10":
                rows.append(at_most(title, value, "of plain", WANTED[q], theirs))
            else:
                rows.append(informative(title, value, "of plain", theirs, detail=region != WHOLE))
    return rows


def _which_S_rows(people: Mapping[str, Scores]) -> list[Row]:
    rows = []
    for q, wanted in WANTED.items():
        ours, literal = (largest_S(curve(people, e)[:, q], wanted) for e in (OURS, LITERAL))
        title = f"marching: largest S with the published {100 * (wanted - 1):+.0f} % of {QUANTITIES[q]}"
        rows.append(informative(title, ours, "(rad/s3)2", literal))
    return rows


def _prediction_rows(people: Mapping[str, Scores], at: str, S: float) -> list[Row]:
    rows = []
    for model in MODELS:
        by = {e: _prediction([s[Setting(model, e, S)] for s in people.values()]) for e in (OURS, PLAIN)}
        for kind, (title, unit) in enumerate((("gyroscope", "deg/s"), ("accelerometer", "m/s2"))):
            for place, where in enumerate(("thigh", "shank")):
                name = f"marching at {at}, next sample, {where} {title}, {MODEL_WORDS[model]} (EKF)"
                value, base = (float(by[e][kind, place]) for e in (OURS, PLAIN))
                rows.append(informative(name, value, unit, base, detail=True))
    return rows


def _prediction(scores: Sequence[Score]) -> "np.typing.NDArray[np.float64]":
    mean = np.mean([score.prediction for score in scores], axis=0)
    return np.asarray([np.degrees(mean[0]), mean[1]])
