"""One leg of a session: its estimator, what is kept until it is believed, what may be believed of it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import Misplacement
from services.biomech.worn_legs import WornLeg
from services.estimation.knee.estimator import Fitting, Kept, KneeEstimator, KneeSample
from services.estimation.knee.instants import Instant
from services.estimation.knee.placement_watch import PlacementWatch
from services.estimation.parameters import KneeParameters
from services.estimation.samples import FORCE, RATE
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]

NOTHING_YET = KneeSample(0.0, 1.0, 0.0, 0.0, 0.0, 0.0, False)


class LegState(NamedTuple):
    """One leg at one instant, as it is published."""

    sample: KneeSample
    is_valid: bool  # the flexion; and thigh and shank have the tilt that the angles say
    dt_s: float  # since the instant before


class Leg:
    """Sensors are rows `first` and `first` + 1 of an instant's samples, thigh first."""

    def __init__(
        self, worn: WornLeg, first: int, estimator: KneeEstimator, silent_after_s: float, parameters: KneeParameters
    ) -> None:
        self.worn = worn
        self.estimator = estimator
        self._rows = slice(first, first + 2)
        self._watch = PlacementWatch(worn.side, worn.sensors, parameters)
        self._doubt_ns, self._kept_ns = round(parameters.doubt_s * 1e9), round(estimator.kept_s * 1e9)
        self._silent_ns = round(silent_after_s * 1e9)
        self._last_ns: int | None = None
        self._doubted_ns = 0
        self._sample = NOTHING_YET
        self._kept: list[tuple[int, Kept]] = []
        self._is_keeping = True
        self._is_settled = False
        self._is_valid = False
        self.has_wrong_units = False
        """Gravity is not what it must be at one of the sensors: nothing is believed."""

    @property
    def is_settled(self) -> bool:
        """The angle is believed, and nothing speaks against how the sensors are worn."""
        return self._is_settled

    @property
    def is_swapped(self) -> bool:
        """The thigh's sensor is on the shank, and the shank's on the thigh."""
        return Misplacement.SWAPPED in self._watch.found

    @property
    def misplaced(self) -> list[Misplacement]:
        """How the sensors are worn otherwise than declared."""
        return self._watch.found

    @property
    def has_kept(self) -> bool:
        """It is believed, and was not when its last samples came."""
        return self._is_settled and self._is_keeping

    def take(self, instant: Instant) -> LegState | None:
        """Take the next instant; None where the method has no angle for it."""
        dt_s = 0.0 if self._last_ns is None else (instant.captured_ns - self._last_ns) / 1e9
        if not all(instant.heard[self._rows]):
            return self._miss(instant.captured_ns, dt_s)
        if self._last_ns is None or instant.captured_ns - self._last_ns > self._silent_ns:
            self._doubted_ns = instant.captured_ns
        self._last_ns = instant.captured_ns
        samples = instant.samples[self._rows]
        kept = Kept(samples[:, RATE], samples[:, FORCE], dt_s)
        sample = self.estimator.step(kept)
        self._keep(instant.captured_ns, kept)
        if sample is None:
            return None
        self._sample = sample
        self._look(kept)
        self._settle()
        return self._state(instant.captured_ns, sample, dt_s)

    def _miss(self, captured_ns: int, dt_s: float) -> LegState:
        """A sensor is silent: the last angles, at rest and not valid."""
        self._doubted_ns = captured_ns
        self._is_valid = False
        held = self._sample._replace(flexion_rate=0.0, inclination_rate=0.0, turn_rate=0.0, is_known=False)
        return LegState(held, False, dt_s)

    def _look(self, kept: Kept) -> None:
        # Sensors that are swapped show no angle, but they turn.
        is_due = self._watch.is_due(float(np.abs(kept.rate).max()), kept.dt_s)
        evidence = self.estimator.evidence() if is_due else None
        if evidence is not None:
            self._watch.look(evidence)

    def _settle(self) -> None:
        """Believed until the estimator begins anew; a suspicion before the start delays it."""
        ready = self.estimator.is_ready and not self.has_wrong_units
        self._is_settled = ready and (self._is_settled or not self._watch.suspects_swap)
        if not ready:
            self._is_keeping = True

    def _state(self, captured_ns: int, sample: KneeSample, dt_s: float) -> LegState:
        doubted = captured_ns - self._doubted_ns < self._doubt_ns
        self._is_valid = sample.is_known and self._is_settled and not doubted and not self.is_swapped
        return LegState(sample, self._is_valid, dt_s)

    def _keep(self, captured_ns: int, kept: Kept) -> None:
        if not self._is_keeping:
            return
        self._kept.append((captured_ns, kept))
        if self._kept[0][0] < captured_ns - self._kept_ns:
            late = next(i for i, (ns, _) in enumerate(self._kept) if ns >= captured_ns - self._kept_ns)
            del self._kept[:late]

    def finish(self) -> None:
        """The stream has ended: make do with what there is."""
        self.estimator.finish()
        self._settle()

    def catch_up(self) -> dict[int, LegState]:
        """What was kept, up to the newest sample, as it is seen now that the leg is settled; by captured time."""
        kept, self._kept, self._is_keeping = self._kept, [], False
        if not kept:
            return {}
        doubted_ns, self._doubted_ns = self._doubted_ns, kept[0][0]
        states: dict[int, LegState] = {}
        for (captured_ns, each), sample in zip(kept, self.estimator.again([k for _, k in kept]), strict=True):
            if each.dt_s * 1e9 > self._silent_ns:
                self._doubted_ns = captured_ns
            if sample is not None:
                states[captured_ns] = self._state(captured_ns, sample, each.dt_s)
                self._sample = sample
        self._doubted_ns = max(self._doubted_ns, doubted_ns)
        return states

    def fitting(self) -> Fitting:
        """How both sensors sit."""
        return self.estimator.fitting()

    def snapshot(self) -> State:
        """Everything that changes."""
        kept = [[*k.rate.ravel(), *k.force.ravel(), k.dt_s] for _, k in self._kept]
        return {
            "estimator": self.estimator.snapshot(),
            "watch": self._watch.snapshot(),
            "times_ns": [self._last_ns, self._doubted_ns],
            "sample": list(self._sample),
            "flags": [self._is_keeping, self._is_settled, self._is_valid, self.has_wrong_units],
            "kept_ns": [ns for ns, _ in self._kept],
            "kept": pack_array(np.array(kept).reshape(-1, 13)),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.estimator.restore(state["estimator"])
        self._watch.restore(state["watch"])
        self._last_ns, self._doubted_ns = state["times_ns"]
        self._sample = KneeSample(*state["sample"])
        self._is_keeping, self._is_settled, self._is_valid, self.has_wrong_units = state["flags"]
        self._kept = [
            (ns, Kept(row[:6].reshape(2, 3).copy(), row[6:12].reshape(2, 3).copy(), float(row[12])))
            for ns, row in zip(state["kept_ns"], unpack_array(state["kept"]), strict=True)
        ]
