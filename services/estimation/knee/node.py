"""Samples of thigh and shank become knee flexion, with the rhythm, a calibration and a picture for the screen."""

from collections.abc import Sequence

import numpy as np

from schemas.health import Reason, Rejection
from schemas.rhythm import LearnedRhythm
from schemas.session import SessionDescription
from schemas.signals import CALIBRATION, LEARNED_RHYTHM, LIVE_POSE
from schemas.standing import StandingMark
from schemas.vocabulary import Segment
from services.biomech.rhythm.trusted import TrustedRhythm
from services.biomech.worn_legs import worn_legs
from services.estimation.estimates import OUTPUTS, estimates
from services.estimation.intake import Intake
from services.estimation.knee.chain_of_angles import ChainOfAngles
from services.estimation.knee.estimators import estimator_of
from services.estimation.knee.fitted_legs import FittedLegs
from services.estimation.knee.instants import CommonInstants, Instant
from services.estimation.knee.leg import Leg, LegState
from services.estimation.knee.screen import Screen
from services.estimation.knee.worn_legs import used_by_knees
from services.estimation.learning import RhythmLearning, start_rhythm
from services.estimation.marked_standing import Marks
from services.estimation.parameters import EstimationParameters
from services.estimation.quality import QualityWatch, Source
from services.estimation.rows import RHYTHM_CHANNELS, Row
from services.estimation.samples import Tick, TickBatch
from services.estimation.standing import StandingDetector, StandingReference
from services.flow.message import Message, Output, Stream
from services.flow.node import State

LONGEST_RUN = 50
"""Rows of one message at most: catching up has thousands."""


class KneeNode:
    """One session: each leg with a thigh and a shank sensor is a knee of its own.

    Rows begin with the first sample that was kept when the legs are believed; the numbers do not depend on how the
    samples were batched into messages. At least one leg must wear both sensors.
    """

    outputs = OUTPUTS

    def __init__(self, description: SessionDescription, parameters: EstimationParameters | None = None) -> None:
        p = self._parameters = parameters or EstimationParameters()
        worn = worn_legs(description)
        if not worn:
            raise ValueError(
                f"{description.estimator} needs a sensor on the thigh and one on the shank of one leg: "
                "assign the sensors anew, or choose an estimator of the lower body"
            )
        self._intake = Intake(description, p, used_by_knees(description))
        sensors, silent_s = self._intake.sensors, p.checks.silent_after_s
        self._instants = CommonInstants([sensor.rate_hz for sensor in sensors], silent_s, p.knee.instant_share)
        self._legs = [
            Leg(leg, 2 * k, estimator_of(description.estimator, leg, p.knee), silent_s, p.knee)
            for k, leg in enumerate(worn)
        ]
        self._standing = StandingDetector(sensors, description.standing, p.standing)
        self._reference: StandingReference | None = None
        self._marks = Marks(sensors, p.standing, p.notice_s)
        rhythm = TrustedRhythm(len(RHYTHM_CHANNELS), p.filter.rhythm)
        start_rhythm(rhythm, description.known_rhythms)
        self._chain = ChainOfAngles([leg.side for leg in worn], rhythm, p.knee)
        self._learning = RhythmLearning()
        self._fitted = FittedLegs(description, self._legs, self._intake.unused, p.knee.axis_change)
        self._screen = Screen(description, self._intake, self._legs, p.live_rate_hz)
        sources = [Source(sensor.name, sensor.rate_hz, sensor.segment) for sensor in sensors]
        knees = [f"knee_flexion_{leg.side}" for leg in worn]
        self._quality = QualityWatch(sources, knees, self._intake.checks.refused_before, p.quality)
        self._has_started = False
        self._first_settled_ns: int | None = None
        self._looked_ns = 0

    @property
    def streams(self) -> tuple[Stream, ...]:
        """One imu stream per hub."""
        return self._intake.streams

    def step(self, message: Message) -> list[Output]:
        """Take one imu message."""
        self._marks.note(message.payload)
        return [output for batch in self._intake.accept(message) for output in self._take(batch)]

    def finish(self) -> list[Output]:
        """Take what waited, and believe what there is."""
        outputs = [output for batch in self._intake.finish() for output in self._take(batch)]
        run = _Run()
        for instant in self._instants.finish():
            self._advance(instant, run)
        if not self._has_started:
            for leg in self._legs:
                leg.finish()
            if any(leg.is_settled for leg in self._legs):
                self._start(run)
        outputs += run.finish()
        self._quality.hear(run.unheard())
        return outputs + _learned(self._learning.report()) + self._quality.finish()

    def rejections(self) -> list[Rejection]:
        """Counts by sensor and reason."""
        return self._intake.checks.rejections()

    def _take(self, batch: TickBatch) -> list[Output]:
        run = _Run()
        for marks, ticks in self._marks.runs(batch.ticks):
            for mark in marks:
                self._hear(mark, ticks[0].captured_ns)
            self._marks.watch(ticks)
            for tick in ticks:
                self._tell_quality(tick, run)
                self._watch_standing(tick)
                for instant in self._instants.add(tick):
                    self._advance(instant, run)
        outputs = run.finish()
        self._quality.hear(run.unheard())
        return outputs + self._picture(batch.captured_ns, run)

    def _tell_quality(self, tick: Tick, run: "_Run") -> None:
        """What was before this tick, when it is time; then the tick is counted."""
        if self._quality.is_due(tick.captured_ns):
            run.close()
            self._quality.hear(run.unheard())
            run.outputs += self._quality.due(tick.captured_ns)
        self._quality.count((tick,))

    def _watch_standing(self, tick: Tick) -> None:
        """Wrong units are seen at rest; a standing that the description marks is the zero."""
        self._standing.add(tick)
        reference = self._standing.reference
        if reference is None or reference is self._reference:
            return
        self._reference = reference
        for k, leg in enumerate(self._legs):
            wrong = reference.wrong_units[2 * k : 2 * k + 2]
            if wrong.any() and not leg.has_wrong_units:
                for s in np.flatnonzero(wrong):
                    self._intake.checks.refuse(leg.worn.sensors[s].name, Reason.WRONG_UNITS)
            leg.has_wrong_units = bool(wrong.any())
        if self._standing.marked:
            self._stand(reference)

    def _hear(self, mark: StandingMark, now_ns: int) -> None:
        """The operator marked a standing: the zero from now on, and for what was kept."""
        standing = self._marks.judge(mark, self._fitted.alignment() if self._has_started else None, now_ns)
        if standing is None:
            return
        if not self._stand(standing):
            self._marks.refuse("no leg had both its sensors", now_ns)
            return
        after = "Angles refer to the marked standing from now on"
        self._marks.say(after if self._has_started else "Standing taken as marked", now_ns)
        self._looked_ns = -1

    def _stand(self, reference: StandingReference) -> bool:
        """Tell the legs; whether any had both its sensors."""
        told = False
        for k, leg in enumerate(self._legs):
            rows = slice(2 * k, 2 * k + 2)
            if reference.usable[rows].all():
                leg.estimator.stand(reference.mean_force[rows])
                told = True
        return told

    def _advance(self, instant: Instant, run: "_Run") -> None:
        """Take one instant into every leg; its row, once there are rows."""
        states = [leg.take(instant) for leg in self._legs]
        if not self._has_started:
            if self._may_start(instant.captured_ns):
                self._start(run)
            return
        for leg in self._legs:
            if leg.has_kept:
                # Believed anew: what was kept meanwhile tells its zero; its rows have been sent.
                leg.catch_up()
        if not all(state is None for state in states):
            self._publish(instant.captured_ns, states, run)
        if self._looked_ns < 0 or instant.captured_ns - self._looked_ns >= self._parameters.knee.look_s * 1e9:
            self._tell(instant.captured_ns, run)

    def _may_start(self, now_ns: int) -> bool:
        """Every leg is believed, or known to be swapped; or one has been for a while."""
        clear = [leg.is_settled or (leg.is_swapped and leg.estimator.is_fitted) for leg in self._legs]
        if not any(clear):
            self._first_settled_ns = None
            return False
        if self._first_settled_ns is None:
            self._first_settled_ns = now_ns
        return all(clear) or now_ns - self._first_settled_ns >= self._parameters.knee.together_s * 1e9

    def _start(self, run: "_Run") -> None:
        """Publish what was kept, with the calibration before it."""
        self._has_started = True
        kept = [leg.catch_up() if leg.is_settled else {} for leg in self._legs]
        times = sorted({captured_ns for states in kept for captured_ns in states})
        self._tell(times[-1] if times else 0, run, captured_ns=times[0] if times else 0)
        for captured_ns in times:
            self._publish(captured_ns, [states.get(captured_ns) for states in kept], run)

    def _tell(self, now_ns: int, run: "_Run", captured_ns: int | None = None) -> None:
        """Look whether the calibration has news."""
        self._looked_ns = now_ns
        calibration = self._fitted.news()
        if calibration is not None:
            run.outputs.append(Output(CALIBRATION, now_ns if captured_ns is None else captured_ns, calibration))

    def _publish(self, captured_ns: int, states: Sequence[LegState | None], run: "_Run") -> None:
        row, valid = self._chain.row(captured_ns, states), self._chain.validity(states)
        pairs = zip(self._legs, states, strict=True)
        observed = [s for leg, state in pairs if state is not None and state.is_valid for s in leg.worn.segments]
        run.add(row, valid, observed)
        run.learned += _learned(self._learning.take(row, valid))

    def _picture(self, captured_ns: int, run: "_Run") -> list[Output]:
        if not self._has_started:
            if not self._screen.pace.is_due(captured_ns):
                return []
            pose = self._screen.waiting(captured_ns, self._marks.notice_at(captured_ns), self._reference)
            return [Output(LIVE_POSE, captured_ns, pose)]
        if run.last is None or not self._screen.pace.is_due(run.last.captured_ns):
            return []
        now_ns = run.last.captured_ns
        notice = self._marks.notice_at(now_ns)
        pose = self._screen.drawn(run.last, run.valid, run.observed, notice, self._reference)
        return [Output(LIVE_POSE, now_ns, pose)]

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "intake": self._intake.snapshot(),
            "instants": self._instants.snapshot(),
            "legs": [leg.snapshot() for leg in self._legs],
            "standing": self._standing.snapshot(),
            "has_reference": self._reference is not None,
            "marks": self._marks.snapshot(),
            "chain": self._chain.snapshot(),
            "learning": self._learning.snapshot(),
            "fitted": self._fitted.snapshot(),
            "times_ns": [self._first_settled_ns, self._looked_ns, self._screen.pace.next_ns],
            "has_started": self._has_started,
            "quality": self._quality.snapshot(),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`, for a node built from the same description and parameters."""
        self._intake.restore(state["intake"])
        self._instants.restore(state["instants"])
        for leg, saved in zip(self._legs, state["legs"], strict=True):
            leg.restore(saved)
        self._standing.restore(state["standing"])
        self._reference = self._standing.reference if state["has_reference"] else None
        self._marks.restore(state["marks"])
        self._chain.restore(state["chain"])
        self._learning.restore(state["learning"])
        self._fitted.restore(state["fitted"])
        self._first_settled_ns, self._looked_ns, self._screen.pace.next_ns = state["times_ns"]
        self._has_started = state["has_started"]
        self._quality.restore(state["quality"])


class _Run:
    """Rows of one batch as messages: one for each run of equal validity."""

    def __init__(self) -> None:
        self.outputs: list[Output] = []
        self.learned: list[Output] = []
        self.last: Row | None = None
        self.valid: list[bool] = []
        self.observed: list[Segment] = []
        self._rows: list[Row] = []
        self._heard = 0

    def add(self, row: Row, valid: list[bool], observed: list[Segment]) -> None:
        """Take the next row."""
        if self._rows and (valid != self.valid or observed != self.observed or len(self._rows) >= LONGEST_RUN):
            self.close()
        self._rows.append(row)
        self.last, self.valid, self.observed = row, valid, observed

    def close(self) -> None:
        """What comes next is not to be in one message with what was before."""
        if self._rows:
            self.outputs += estimates(self._rows, self.valid, self.observed)
        self._rows = []

    def unheard(self) -> list[Output]:
        """The messages since this was asked last."""
        heard, self._heard = self._heard, len(self.outputs)
        return self.outputs[heard:]

    def finish(self) -> list[Output]:
        """All messages, and what was learned after them."""
        self.close()
        return self.outputs + self.learned


def _learned(rhythm: LearnedRhythm | None) -> list[Output]:
    return [] if rhythm is None else [Output(LEARNED_RHYTHM, rhythm.captured_ns, rhythm)]
