"""From the first sample to the calibrated body: wait for standing, then for the first steps."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.health import Reason
from schemas.session import SensorDescription, SessionDescription
from schemas.vocabulary import LOWER_BODY_ESTIMATORS
from services.biomech.rotations import angle_between
from services.estimation.alignment import Alignment
from services.estimation.lower_body.axis_search import AxisSearch, FlexionAxis
from services.estimation.lower_body.lower_body_filter import Calibrated
from services.estimation.lower_body.sitting import rose_from_sitting
from services.estimation.lower_body.walking_reference import lean, refer_to_walking
from services.estimation.parameters import EstimationParameters
from services.estimation.samples import TickBatch, pack_batches, unpack_batches
from services.estimation.sensor_checks import SensorChecks
from services.estimation.standing import StandingDetector, StandingReference, pack_reference, unpack_reference
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]
STAND = "Stand still, upright"


class Calibrator:
    """Keeps what may have to be estimated later, until the body is calibrated.

    While the person stands, the last `before_walking_s` are kept. From then on every batch is kept, at most
    `give_up_after_s`: once the axes are clear (some seconds into the walk) the filter runs over all of them. Where
    nobody has stood for `walking.wait_s`, straight walking takes the place of standing.
    """

    def __init__(
        self, description: SessionDescription, sensors: Sequence[SensorDescription], parameters: EstimationParameters
    ) -> None:
        if description.estimator not in LOWER_BODY_ESTIMATORS:
            raise ValueError(
                f"estimation has no estimator {description.estimator!r}; choose from {list(LOWER_BODY_ESTIMATORS)}"
            )
        self.sensors = list(sensors)
        self.parameters = parameters
        self.standing = StandingDetector(self.sensors, description.standing, parameters.standing)
        self.batches: list[TickBatch] = []
        self._looked_ns = 0
        self._first_ns: int | None = None
        self._axes: dict[int, FlexionAxis] = {}
        self._refused: list[int] = []
        self._begun: StandingReference | None = None

    @property
    def reference(self) -> StandingReference | None:
        """The standing that counts: the one before the movement that is being looked at, else the newest."""
        return self._begun or self.standing.reference

    @property
    def refused(self) -> NDArray[np.bool_]:
        """(S,) sensors whose gravity was wrong in standing."""
        count = len(self.sensors)
        return np.zeros(count, dtype=np.bool_) if self.reference is None else self.reference.wrong_units

    def message(self) -> str:
        """What the therapist should do now."""
        if self.reference is None:
            return "Sitting, not standing: please stand up straight" if self.standing.is_sitting else STAND
        wrong = [self.sensors[s].name for s in np.flatnonzero(self.refused)]
        if wrong:
            forces = np.linalg.norm(self.reference.mean_force[self.refused], axis=1)
            values = ", ".join(f"{name} {force:.2f}" for name, force in zip(wrong, forces, strict=True))
            return f"Wrong units: at rest 9.8 m/s2 is expected, measured {values}"
        return "Walk a few steps"

    def add(self, batch: TickBatch, checks: SensorChecks) -> Calibrated | None:
        """Take the next batch; the calibration, once it stands."""
        for tick in batch.ticks:
            self.standing.add(tick)
        self.batches.append(batch)
        if self._first_ns is None:
            self._first_ns = batch.captured_ns
        if self._nobody_stood():
            return self._wait_without_standing(batch.captured_ns)
        reference = self._moving_since(self.standing.reference)
        if reference is None:
            self._keep(self.parameters.before_walking_s, batch.captured_ns)
            self._looked_ns, self._axes = batch.captured_ns, {}
            return None
        self._report_units(reference, checks)
        if batch.captured_ns - self._looked_ns < self.parameters.alignment.look_every_s * 1e9:
            return None
        self._looked_ns = batch.captured_ns
        return self._look(reference)

    def take_mark(self, reference: StandingReference) -> None:
        """The operator has marked a standing before the calibration: the first steps are looked for from here on."""
        self.standing.decide(reference)
        self._begun, self._axes = None, {}
        self._keep_from(reference.until_ns - round(self.parameters.before_walking_s * 1e9))

    def realign(self, reference: StandingReference) -> Calibrated | None:
        """The calibration with another standing, after the first: new verticals and biases, the same flexion axes."""
        calibrated = self._calibrated(reference, AxisSearch(self.sensors, reference, self.parameters.alignment))
        if calibrated is not None:
            self.standing.decide(reference)
            self._begun = reference
        return calibrated

    def _nobody_stood(self) -> bool:
        return self.standing.reference is None and not self.standing.marked and not self.standing.is_still

    def _wait_without_standing(self, now_ns: int) -> Calibrated | None:
        """Standing is still hoped for; after a while, walking will do."""
        assert self._first_ns is not None
        self._keep(self.parameters.alignment.give_up_after_s, now_ns)
        is_due = now_ns - self._looked_ns >= self.parameters.alignment.look_every_s * 1e9
        if now_ns - self._first_ns < self.parameters.walking.wait_s * 1e9 or not is_due:
            return None
        self._looked_ns = now_ns
        return self._from_walking()

    def _from_walking(self) -> Calibrated | None:
        """The calibration from the straight strides at hand. What was kept before them is dropped."""
        p = self.parameters
        ticks = [tick for batch in self.batches for tick in batch.ticks]
        walked = refer_to_walking(self.sensors, ticks, p.walking, p.standing)
        if walked is None:
            return None
        search = AxisSearch(self.sensors, walked.reference, p.alignment)
        used = [tick for tick in ticks if tick.captured_ns >= walked.from_ns]
        axes = search.axes(np.array([tick.samples for tick in used]), np.array([tick.fresh for tick in used]))
        alignment = lean(search.align(axes), self.sensors, p.walking)
        if not search.is_moving(axes) or not alignment.aligned.any():
            return None
        self.batches = [
            batch for batch in self.batches if batch.ticks and batch.ticks[-1].captured_ns >= walked.from_ns
        ]
        self._axes = axes
        return Calibrated(alignment, walked.reference.gyro_bias, from_walking=True)

    def _moving_since(self, newest: StandingReference | None) -> StandingReference | None:
        """The standing from which the movement at hand began; None before it.

        Pauses in an exercise are standing too: as long as the sensors' verticals are the same, the movement goes on.
        When they are not, a sensor was moved or the first posture was another: begin again from the newest.
        """
        if self._begun is not None and newest is not None and not self._agree(self._begun, newest):
            self._begun = None
        if self._begun is None and not self.standing.is_still:
            self._begun = newest
        return self._begun

    def _agree(self, before: StandingReference, now: StandingReference) -> bool:
        return all(
            angle_between(before.mean_force[s], now.mean_force[s]) <= self.parameters.standing.same_vertical
            for s in np.flatnonzero(before.usable & now.usable)
        )

    def finish(self) -> Calibrated | None:
        """The stream has ended: calibrate with what there is, if there was a standing and a movement."""
        if self.standing.reference is None and not self.standing.marked:
            return self._from_walking()
        if self._begun is None or not self._axes:
            return None
        return self._calibrated(self._begun, AxisSearch(self.sensors, self._begun, self.parameters.alignment))

    def _keep(self, seconds: float, now_ns: int) -> None:
        self._keep_from(now_ns - round(seconds * 1e9))

    def _keep_from(self, oldest_ns: int) -> None:
        first = next((i for i, batch in enumerate(self.batches) if batch.captured_ns >= oldest_ns), 0)
        del self.batches[:first]

    def _report_units(self, reference: StandingReference, checks: SensorChecks) -> None:
        refused = [int(s) for s in np.flatnonzero(reference.wrong_units)]
        for s in refused:
            if s not in self._refused:
                checks.refuse(self.sensors[s].name, Reason.WRONG_UNITS)
        self._refused = refused

    def _look(self, reference: StandingReference) -> Calibrated | None:
        limits = self.parameters.alignment
        search = AxisSearch(self.sensors, reference, limits)
        ticks = [tick for batch in self.batches for tick in batch.ticks]
        if not ticks:
            return None
        axes = search.axes(np.array([tick.samples for tick in ticks]), np.array([tick.fresh for tick in ticks]))
        if not self.standing.marked and rose_from_sitting(
            reference, axes, self.sensors, ticks, self.parameters.standing
        ):
            self.standing.withdraw()
            self._begun, self._axes = None, {}
            return None
        clear = search.is_clear(axes, self._axes)
        self._axes = axes
        kept_s = (self.batches[-1].captured_ns - self.batches[0].captured_ns) / 1e9
        if clear or (kept_s >= limits.give_up_after_s and search.is_moving(axes)):
            return self._calibrated(reference, search)
        self._keep(limits.give_up_after_s, self.batches[-1].captured_ns)
        return None

    def _calibrated(self, reference: StandingReference, search: AxisSearch) -> Calibrated | None:
        alignment = search.align(self._axes)
        if not alignment.aligned.any():
            return None
        return Calibrated(alignment, reference.gyro_bias, marked=reference.marked)

    def snapshot(self) -> State:
        """Standing, kept batches and the axes of the last look."""
        axes = sorted(self._axes.items())
        table = [[*axis.right, axis.ratio, axis.moving_s, axis.fastest, float(axis.sign_is_placed)] for _, axis in axes]
        return {
            "standing": self.standing.snapshot(),
            "batches": pack_batches(self.batches),
            "looked_ns": self._looked_ns,
            "first_ns": self._first_ns,
            "axes_of": [s for s, _ in axes],
            "axes": pack_array(np.array(table).reshape(-1, 7)),
            "refused": self._refused,
            "begun": None if self._begun is None else pack_reference(self._begun),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.standing.restore(state["standing"])
        self.batches = unpack_batches(state["batches"], len(self.sensors))
        self._looked_ns, self._refused = state["looked_ns"], list(state["refused"])
        self._first_ns = state["first_ns"]
        self._begun = None if state["begun"] is None else unpack_reference(state["begun"])
        rows = unpack_array(state["axes"])
        self._axes = {
            s: FlexionAxis(row[:3].copy(), float(row[3]), float(row[4]), float(row[5]), bool(row[6]))
            for s, row in zip(state["axes_of"], rows, strict=True)
        }


def pack_calibrated(calibrated: Calibrated) -> State:
    """As JSON values, to the bit."""
    alignment = calibrated.alignment
    return {
        "frames": pack_array(alignment.R_segment_from_sensor),
        "quality": pack_array(alignment.quality),
        "aligned": [bool(flag) for flag in alignment.aligned],
        "gyro_bias": pack_array(calibrated.gyro_bias),
        "from_walking": calibrated.from_walking,
        "marked": calibrated.marked,
    }


def unpack_calibrated(state: State) -> Calibrated:
    """Inverse of `pack_calibrated`."""
    aligned = np.array(state["aligned"], dtype=np.bool_)
    alignment = Alignment(unpack_array(state["frames"]), unpack_array(state["quality"]), aligned)
    return Calibrated(alignment, unpack_array(state["gyro_bias"]), state["from_walking"], state["marked"])
