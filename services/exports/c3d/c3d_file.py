"""A session as a C3D file: header, parameters, frames at even times."""

import struct
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.gait import GaitEvent
from schemas.metrics import Metric, SessionMetrics
from schemas.vocabulary import GaitEventKind
from services.exports.c3d.parameter_section import BLOCK, Group, Parameter, encode_groups
from services.exports.c3d.points import LABELS, Outputs, angle_outputs, frames
from services.exports.facts import STRIDES_AND_STEPS, Facts, conditions_in_words
from services.exports.joint_positions import Positions, joint_positions
from services.exports.motion import Motion, even_rate_hz, even_times, nominal_rates_hz
from services.flow.software import SOFTWARE

_MAGIC = 80
_FIRST_PARAMETER_BLOCK = 2
_MOST_FRAMES_IN_A_WORD = 65535
_PER_PARAMETER = 255
"""Entries of a parameter; the next go into NAME2, NAME3, ... as the format's overflow of labels does."""
_MOST_EVENTS = 8 * _PER_PARAMETER
EVENT_LABELS = {GaitEventKind.INITIAL_CONTACT: "Foot Strike", GaitEventKind.TOE_OFF: "Foot Off"}
ANALYSIS_NAMES = {
    "cadence": "Cadence",
    "walking_speed": "Walking Speed",
    "stride_time": "Stride Time",
    "step_time": "Step Time",
    "stride_length": "Stride Length",
    "step_length": "Step Length",
    "step_width": "Step Width",
    "stance_fraction": "Foot Off",
    "single_support_time": "Single Support",
    "double_support_time": "Double Support",
}
"""Names that readers of ANALYSIS know; ours otherwise. A share of the stride becomes %, as they expect."""


def c3d_file(
    facts: Facts, motion: Motion, events: Sequence[GaitEvent], metrics: SessionMetrics | None
) -> Iterator[bytes]:
    """The file in parts.

    Points are joint centres in mm, y up, where they are known, and model outputs of the group ANGLES in degrees.
    Times count from the first sample, whose session time is AMBULA:START_TIME. Raises ExportError.
    """
    rate_hz = even_rate_hz(motion.angles.times_ns, nominal_rates_hz(facts.description))
    times_ns = even_times(motion.angles.times_ns, rate_hz)
    positions = joint_positions(motion, facts.description.anthropometry)
    outputs = angle_outputs(motion)
    points = (0 if positions is None else len(positions.names)) + len(outputs.labels)
    start_ns = int(times_ns[0])
    others = [
        _trial(times_ns.size, rate_hz),
        _subject(facts),
        *_event_groups(facts, events, start_ns, int(times_ns[-1])),
        _analysis(facts, metrics),
        _ambula(facts, positions, start_ns, len(events)),
    ]
    about = (positions, outputs, points, times_ns.size, rate_hz)
    blocks = len(encode_groups([_point(*about, data_start=0), *others])) // BLOCK
    data_start = _FIRST_PARAMETER_BLOCK + blocks
    yield _header(points, times_ns.size, rate_hz, data_start)
    yield encode_groups([_point(*about, data_start=data_start), *others])
    yield from frames(motion, positions, outputs, times_ns, rate_hz)
    # Where the count does not fit its word, readers take frames to the end of the file: no filling up of a block then.
    if times_ns.size <= _MOST_FRAMES_IN_A_WORD:
        yield bytes(-(times_ns.size * points * 16) % BLOCK)


def _header(points: int, count: int, rate_hz: float, data_start: int) -> bytes:
    last = min(count, _MOST_FRAMES_IN_A_WORD)
    head = struct.pack(
        "<BBHHHHHfHHf", _FIRST_PARAMETER_BLOCK, _MAGIC, points, 0, 1, last, 0, -1.0, data_start, 0, rate_hz
    )
    return head.ljust(BLOCK, b"\x00")


def _point(
    positions: Positions | None, outputs: Outputs, points: int, count: int, rate_hz: float, *, data_start: int
) -> Group:
    centres = () if positions is None else positions.names
    about = "" if positions is None else positions.origin
    parameters = [
        Parameter("USED", points),
        Parameter("FRAMES", _word(min(count, _MOST_FRAMES_IN_A_WORD))),
        Parameter("LONG_FRAMES", float(count)),
        Parameter("DATA_START", data_start),
        Parameter("SCALE", -1.0),
        Parameter("RATE", rate_hz),
        Parameter("X_SCREEN", "+X"),
        Parameter("Y_SCREEN", "+Y"),
        Parameter("UNITS", "mm"),
        Parameter("ANGLE_UNITS", "deg"),
        Parameter("LABELS", [*(LABELS[name] for name in centres), *outputs.labels]),
        Parameter("DESCRIPTIONS", [*(f"{name}: {about}" for name in centres), *outputs.descriptions]),
    ]
    if outputs.labels:
        parameters += [Parameter("ANGLES", outputs.labels), _type_groups()]
    return Group("POINT", parameters, "joint centres, and angles as model outputs")


def _type_groups() -> Parameter:
    return Parameter("TYPE_GROUPS", ["ANGLES", "ANGLE"], "parameter with labels, and prefix of its unit", (2, 1))


def _trial(count: int, rate_hz: float) -> Group:
    parameters = [
        Parameter("ACTUAL_START_FIELD", _words(1)),
        Parameter("ACTUAL_END_FIELD", _words(count)),
        Parameter("CAMERA_RATE", rate_hz),
    ]
    return Group("TRIAL", parameters)


def _subject(facts: Facts) -> Group:
    name = facts.description.session
    return Group("SUBJECTS", [Parameter("USED", 1), Parameter("NAMES", [name]), Parameter("USES_PREFIXES", 0)])


def _event_groups(facts: Facts, events: Sequence[GaitEvent], start_ns: int, end_ns: int) -> list[Group]:
    contexts = Group(
        "EVENT_CONTEXT",
        [Parameter("USED", 3), Parameter("LABELS", ["General", "Left", "Right"])],
    )
    inside = [event for event in events if start_ns <= event.captured_ns <= end_ns][:_MOST_EVENTS]
    parameters = [Parameter("USED", len(inside))]
    for number, first in enumerate(range(0, len(inside), _PER_PARAMETER), 1):
        some = inside[first : first + _PER_PARAMETER]
        ending = "" if number == 1 else str(number)
        seconds = [(event.captured_ns - start_ns) * 1e-9 for event in some]
        times = np.array([[second // 60 for second in seconds], [second % 60 for second in seconds]], dtype="<f4")
        parameters += [
            Parameter(f"CONTEXTS{ending}", [event.side.capitalize() for event in some]),
            Parameter(f"LABELS{ending}", [EVENT_LABELS[event.kind] for event in some]),
            Parameter(f"SUBJECTS{ending}", [facts.description.session] * len(some)),
            Parameter(f"TIMES{ending}", times, "minutes, seconds since the first frame"),
            Parameter(f"ICON_IDS{ending}", np.array([1 + (event.kind == "toe_off") for event in some], dtype="<i2")),
        ]
    return [contexts, Group("EVENT", parameters, "foot contacts")]


def _analysis(facts: Facts, metrics: SessionMetrics | None) -> Group:
    told = [] if metrics is None else [metric for metric in metrics.metrics if metric.value is not None]
    told = sorted(told, key=lambda metric: metric.name not in ANALYSIS_NAMES)[:_PER_PARAMETER]
    units, values = zip(*(_as_expected(metric) for metric in told), strict=True) if told else ((), ())
    parameters = [
        Parameter("USED", len(told)),
        Parameter("NAMES", [ANALYSIS_NAMES.get(metric.name, metric.name) for metric in told]),
        Parameter("CONTEXTS", [(metric.side or "general").capitalize() for metric in told]),
        Parameter("SUBJECTS", [facts.description.session] * len(told)),
        Parameter("DESCRIPTIONS", [f"n {metric.strides}, {metric.grade}" for metric in told]),
        Parameter("UNITS", list(units)),
        Parameter("VALUES", np.array(values, dtype="<f4")),
    ]
    return Group("ANALYSIS", parameters if told else parameters[:1])


def _as_expected(metric: Metric) -> tuple[str, float]:
    value = float(metric.value or 0.0)
    if metric.unit == "rad":
        return "deg", float(np.degrees(value))
    return ("%", 100.0 * value) if metric.name.endswith("_fraction") else (metric.unit, value)


def _ambula(facts: Facts, positions: Positions | None, start_ns: int, events: int) -> Group:
    about = facts.description
    parameters = [
        Parameter("SOFTWARE", SOFTWARE),
        Parameter("COMPUTED_BY", facts.computed_by or ""),
        Parameter("SESSION", about.session),
        Parameter("ESTIMATOR", about.estimator),
        Parameter("TASK", str(about.task)),
        Parameter("CONDITIONS", conditions_in_words(about.conditions)),
        Parameter("DATUM", facts.datum),
        Parameter("STRIDE", STRIDES_AND_STEPS),
        Parameter("ORIGIN", "no joint centres" if positions is None else positions.origin),
        Parameter("START_TIME", start_ns * 1e-9, "s since the session started, of the first frame"),
        Parameter("EVENTS", float(events), "foot contacts of the session, those outside the frames included"),
    ]
    return Group("AMBULA", parameters, "what the angles mean; research software, not for diagnosis")


def _word(count: int) -> int:
    """An unsigned word where the format has signed ones."""
    return count if count < 2**15 else count - 2**16


def _words(count: int) -> NDArray[np.int16]:
    """A count as low and high word."""
    return np.array([_word(count % 2**16), count // 2**16], dtype="<i2")
