"""The filters of a person in view behind one face: ours, and the printed one."""

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from services.biomech.whole_body.colombel import ColombelCekf
from services.biomech.whole_body.constrained_ekf import WholeBodyEkf, bounds_of
from services.biomech.whole_body.kernels.tables import COORDINATES, LENGTHS, SEEN
from services.biomech.whole_body.multibody_kinematics import fit_frame
from services.biomech.whole_body.observability import likely_deviations
from services.biomech.whole_body.parameters import StartNoise
from services.biomech.whole_body.presets import CORRECTED, settings_for
from services.biomech.whole_body.start import FITTED_ANGLE_STD, Start, stature_told_by
from services.flow.node import State

Array = NDArray[np.float64]
States = NDArray[np.int64]


class Told(NamedTuple):
    """What a filter says of one instant."""

    q: Array  # (25,) m and rad
    lengths: Array  # (12,) m
    rates: Array  # (22,) rad/s
    accelerations: Array  # (22,) rad/s^2
    deviations: Array  # (2, 22) rad and rad/s
    usable: NDArray[np.bool_]  # (22,) the angle is within its limits and its deviation is one


class BodyFilter(Protocol):
    """One person; a start to begin with."""

    @property
    def absolute(self) -> bool:
        """Whether angles refer to a posture that was known."""

    @property
    def holds_lengths(self) -> bool:
        """Lengths do not change any more."""

    def advance(self, dt_s: float, centres: Array, state: States) -> bool:
        """Predict over dt_s and fuse a frame; False when the filter has diverged and must begin anew."""

    def rejoin(self, centres: Array, state: States) -> None:
        """The person is back after a time out of view, in any posture and at any place."""

    def told(self) -> Told:
        """The estimate."""

    def snapshot(self) -> State:
        """Everything, the start included."""


class OurFilter:
    """`body_cekf`."""

    def __init__(self, ekf: WholeBodyEkf) -> None:
        self._ekf = ekf

    @classmethod
    def begin(cls, start: Start) -> "OurFilter":
        """With the settings that suit the start."""
        return cls(WholeBodyEkf(start, settings_for(standing=start.standing)))

    @classmethod
    def resumed(cls, state: State) -> "OurFilter":
        """From a snapshot."""
        return cls(WholeBodyEkf.resumed(state["ekf"], settings_for(standing=state["standing"])))

    @property
    def absolute(self) -> bool:
        """Started from standing."""
        return self._ekf.start.standing

    @property
    def holds_lengths(self) -> bool:
        """Learnt for long enough."""
        return self._ekf.in_view_s >= self._ekf.settings.lengths_learnt_s

    def advance(self, dt_s: float, centres: Array, state: States) -> bool:
        """One frame."""
        self._ekf.advance(dt_s, centres, state)
        return bool(np.isfinite(self._ekf.x).all())

    def rejoin(self, centres: Array, state: States) -> None:
        """Lengths and biases are kept, the posture is fitted to the first frame and known as well as such a fit."""
        ekf = self._ekf
        biases = ekf.x[SEEN : ekf.velocity].reshape(-1, 3) if ekf.biased else 0.0
        fit = fit_frame(there(centres, state) - biases, state, stature_told_by(ekf.lengths))
        std = np.full(COORDINATES, FITTED_ANGLE_STD)
        std[:3] = ekf.start.noise.position_std
        ekf.start = ekf.start._replace(q_std=std)
        ekf.settle()
        ekf.x[:COORDINATES] = fit.q

    def told(self) -> Told:
        """The estimate within its limits."""
        ekf = self._ekf
        first = ekf.velocity + COORDINATES + 3
        accelerations, deviations = ekf.estimate[first : first + COORDINATES - 3], ekf.deviations()
        deviations[0] = likely_deviations(deviations[0], standing=self.absolute)
        return Told(
            ekf.q.copy(), ekf.lengths.copy(), ekf.rates.copy(), accelerations.copy(), deviations,
            np.ones(COORDINATES - 3, dtype=np.bool_),
        )  # fmt: skip

    def snapshot(self) -> State:
        """The filter."""
        return {"standing": self.absolute, "ekf": self._ekf.snapshot()}


def there(centres: Array, state: States) -> Array:
    """(15, 3) m, NaN where a centre was not seen."""
    return np.where(state[:, None] > 0, centres, np.nan)


PUBLISHED_START = StartNoise(1.0, 1.0, 1.0, 1.0, 1.0)


def published_start(centres: Array, state: States) -> Start:
    """One fitted frame and P0 = I (Colombel, section 3.4)."""
    first = fit_frame(there(centres, state), state)
    return Start(first.q, np.ones(COORDINATES), first.lengths, np.eye(LENGTHS), None, PUBLISHED_START)


class PublishedFilter:
    """`body_cekf_colombel`: as printed, so it may diverge."""

    def __init__(self, ekf: ColombelCekf) -> None:
        self._ekf = ekf
        self._bounds = bounds_of(ekf.start, constrained=True)

    @classmethod
    def begin(cls, start: Start) -> "PublishedFilter":
        """With the process noise that can be said without a recording."""
        return cls(ColombelCekf(start, CORRECTED.process))

    @classmethod
    def resumed(cls, state: State) -> "PublishedFilter":
        """From a snapshot."""
        return cls(ColombelCekf.resumed(state["ekf"], CORRECTED.process))

    @property
    def absolute(self) -> bool:
        """Its start is a fitted frame."""
        return False

    @property
    def holds_lengths(self) -> bool:
        """Never."""
        return False

    def advance(self, dt_s: float, centres: Array, state: States) -> bool:
        """One frame. Lengths that are not those of a body end it as what is not finite does."""
        with np.errstate(all="ignore"):
            self._ekf.advance(dt_s, centres, state)
            return bool(np.isfinite(self._ekf.x).all() and (self._ekf.lengths > 0.0).all())

    def rejoin(self, centres: Array, state: States) -> None:
        """It knows no absence: a new fitted frame."""
        self._ekf = ColombelCekf(published_start(centres, state), CORRECTED.process)
        self._bounds = bounds_of(self._ekf.start, constrained=True)

    def told(self) -> Told:
        """The estimate as it is; an angle beyond its limits, or of a negative variance, is not usable."""
        x, variance = self._ekf.x, np.diagonal(self._ekf.P)
        angles = slice(3, COORDINATES)
        rates, accelerations = slice(SEEN + 3, SEEN + COORDINATES), slice(SEEN + COORDINATES + 3, None)
        deviations = np.stack([variance[angles], variance[rates]])
        within = (x[angles] >= self._bounds.low[:-LENGTHS]) & (x[angles] <= self._bounds.high[:-LENGTHS])
        usable = within & (deviations > 0.0).all(axis=0) & np.isfinite(deviations).all(axis=0)
        return Told(
            x[:COORDINATES].copy(), x[COORDINATES:SEEN].copy(), x[rates].copy(), x[accelerations].copy(),
            np.where(usable, np.sqrt(np.where(usable, deviations, 1.0)), 1.0), usable,
        )  # fmt: skip

    def snapshot(self) -> State:
        """The filter."""
        return {"ekf": self._ekf.snapshot()}


class Kind(NamedTuple):
    """How filters of one name are begun and resumed."""

    begin: Callable[[Start], BodyFilter]
    resumed: Callable[[State], BodyFilter]
    waits: bool
    """For a standing second; the printed one starts from one frame, as its paper says."""


KINDS: dict[str, Kind] = {
    "body_cekf": Kind(OurFilter.begin, OurFilter.resumed, waits=True),
    "body_cekf_colombel": Kind(PublishedFilter.begin, PublishedFilter.resumed, waits=False),
}
"""By the estimator's name in the vocabulary."""

NOBODY = np.zeros((15, 3)), np.zeros(15, dtype=np.int64)
"""A frame without anybody, as a filter takes it."""
