"""What every file says of its session first: software, conditions, datum, the stride, each angle's direction."""

from collections.abc import Iterable
from datetime import UTC, datetime
from typing import NamedTuple

from schemas.conditions import Conditions
from schemas.kinematics import Calibration
from schemas.session import SessionDescription
from schemas.vocabulary import BODY_MODELS, DegreeOfFreedom
from services.definitions.definition import STRIDE_DEFINITION
from services.exports.errors import ExportError
from services.flow.software import SOFTWARE

STRIDES_AND_STEPS = f"{STRIDE_DEFINITION} Steps are named by the leading leg."
UNKNOWN_DATUM = "not known: no calibration had been recorded"


class Facts(NamedTuple):
    """A session and what its angles refer to."""

    description: SessionDescription
    calibration: Calibration | None = None
    computed_by: str | None = None
    """Software that computed the results, where it is known."""

    @property
    def datum(self) -> str:
        """What an angle of zero means."""
        if self.calibration is None:
            return UNKNOWN_DATUM
        constant = "" if self.calibration.absolute else "; each angle carries an unknown constant"
        return f"{self.calibration.datum}{constant}"

    def lines(self) -> list[str]:
        """One `word: value` each, without a person's name or anything free."""
        about = self.description
        started = datetime.fromtimestamp(about.started_unix_ns // 10**9, UTC)
        return [
            f"written by: {SOFTWARE}; research software, not for diagnosis",
            f"computed by: {self.computed_by or 'not said in the recording'}",
            f"session: {about.session}, started {started:%Y-%m-%dT%H:%M:%SZ}; times are s since then",
            f"task: {about.task}; estimator: {about.estimator}; walk path: {about.walk_path}",
            f"conditions: {conditions_in_words(about.conditions)}",
            f"datum of angles: {self.datum}",
            f"stride: {STRIDES_AND_STEPS}",
        ]


def conditions_in_words(conditions: Conditions) -> str:
    """`aid cane, footwear shoes`; what nobody said is not there."""
    said = [f"{name} {value}" for name, value in conditions.model_dump(mode="json").items() if value is not None]
    return ", ".join(said) or "nothing was said"


def freedoms_of(model: str) -> tuple[DegreeOfFreedom, ...]:
    """Degrees of freedom of a joint state. Raises ExportError for a model of another Ambula."""
    if model not in BODY_MODELS:
        known = ", ".join(BODY_MODELS)
        raise ExportError("joint_state.model", f"{model!r} is none of {known}", "export with the Ambula that wrote it")
    return BODY_MODELS[model]


def directions(freedoms: Iterable[DegreeOfFreedom]) -> list[str]:
    """The positive direction of each angle."""
    return [f"{freedom.name}: positive = {freedom.positive}" for freedom in freedoms]
