"""The recorded walk in the report and on the terminal."""

import numpy as np

from services.bench.joukov.marching import LITERAL, OURS, PLAIN, TITLES, Setting, Tuning
from services.bench.joukov.marching_tables import PUBLISHED_ACCELERATION, PUBLISHED_VELOCITY, largest_S
from services.bench.joukov.neura import CUTOFF_HZ, GRID, NeuraStudy
from services.bench.joukov.published_tables import error_table, prediction_table
from services.bench.joukov.regions import BOTTOM, QUANTITIES, TOP, WHOLE
from services.bench.joukov.sections import COLOURS, Finding, Section, change, up_to
from services.bench.line_chart import line_chart
from services.bench.scoreboard import Row, informative

MODEL_WORDS = {"gravity": "accelerometers see gravity alone", "published": "published measurement model"}
TITLE = "A recorded walk: tables II to IV"


def neura_section(study: NeuraStudy, tuning: Tuning) -> Section:
    """Everything about the walk."""
    people = {"neura s02": study.scores}
    tables = [
        error_table(people, "gravity", at, S, region) for region in (TOP, BOTTOM) for at, S in tuning.named.items()
    ]
    tables += [prediction_table(people, MODEL_WORDS, at, S) for at, S in tuning.named.items()]
    paragraphs = [
        "One person of the NeuRA recordings, sensors on pelvis, thighs and shanks and optical markers, 100 Hz; the two "
        "straight passes of the walk, two or three strides each. Truth: knee angle between the lines through the joint "
        f"centres, hip angle between pelvis and thigh; {CUTOFF_HZ:g} Hz zero-phase low-pass, differentiated. S is that "
        "of the virtual participants; nothing was chosen on this walk but one shift between the clocks "
        f"({study.shift} samples, best for the plain filter's positions at the default S).",
        "There are no 15 s to converge in: the walk is 10 s long, and our rhythm is locked in "
        f"{100 * study.locked:.0f} % of the scored time. One person gives no paired test. Without a reviewed phase, "
        "segmentation is not scored here.",
    ]
    return Section(
        TITLE, paragraphs, _rows(study, tuning), tables, {"neura_curve": _chart(study)}, _findings(study, tuning)
    )


def _findings(study: NeuraStudy, tuning: Tuning) -> list[Finding]:
    """How much of it is left in a short recorded walk."""
    found = []
    for q, wanted in ((1, PUBLISHED_VELOCITY), (2, PUBLISHED_ACCELERATION)):
        here, where = [], []
        for estimator in (OURS, LITERAL):
            ratios = {at: float(_ratio(study, estimator, S)[q]) for at, S in tuning.named.items()}
            here.append(f"{TITLES[estimator]} " + ", ".join(f"{change(ratio)} at {at}" for at, ratio in ratios.items()))
            curve = np.array([_ratio(study, estimator, S)[q] for S in GRID.tolist()])
            where.append(f"{TITLES[estimator]}: {up_to(largest_S(curve, wanted))}")
        title = f"the same {QUANTITIES[q]} ({change(wanted)}) in a recorded walk of 10 s"
        found.append(Finding(title, "; ".join(here), "; ".join(where)))
    return found


def missing_section(reason: str) -> Section:
    """Where the recording is not at hand."""
    return Section(TITLE, [reason], [Row("neura: skipped", None, "", reason, None, None)])


def _ratio(study: NeuraStudy, estimator: str, S: float) -> "np.typing.NDArray[np.float64]":
    """Against the plain filter at the same S, (3,): mean of hip and knee."""
    ours, plain = (study.scores[Setting("gravity", e, S)].errors.rmse[WHOLE] for e in (estimator, PLAIN))
    return np.asarray(np.mean(ours / plain, axis=1))


def _rows(study: NeuraStudy, tuning: Tuning) -> list[Row]:
    rows: list[Row] = []
    for at, S in tuning.named.items():
        ours, literal = (_ratio(study, e, S) for e in (OURS, LITERAL))
        for q, quantity in enumerate(QUANTITIES):
            rows.append(informative(f"neura at {at}: {quantity}", float(ours[q]), "of plain", float(literal[q])))
    for at, S in tuning.named.items():
        ours, plain = (study.scores[Setting("gravity", e, S)].prediction for e in (OURS, PLAIN))
        for place, where in enumerate(("thigh", "shank")):
            value, base = (float(np.degrees(p[0, place])) for p in (ours, plain))
            title = f"neura at {at}, next sample, {where} gyroscope (EKF)"
            rows.append(informative(title, value, "deg/s", base, detail=True))
    return rows


def _chart(study: NeuraStudy) -> str:
    lines: dict[str, list[tuple[float, float]]] = {}
    for estimator, title in ((LITERAL, "literal"), (OURS, "ours")):
        for q in (1, 2):
            ratios = [float(_ratio(study, estimator, S)[q]) for S in GRID.tolist()]
            lines[f"{title}, {QUANTITIES[q]}"] = list(zip(GRID.tolist(), ratios, strict=True))
    title = "Recorded walk: error against the plain EKF at the same S"
    return line_chart(
        title,
        "process noise S, (rad/s³)²",
        "ratio of RMSE",
        lines,
        log_x=True,
        from_zero=False,
        levels={"EKF": 1.0},
        colours=COLOURS,
    )
