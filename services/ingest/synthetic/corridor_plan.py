"""When a synthetic person walks, turns and rests in a corridor, so that every turn is made at its end."""

import math
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from services.ingest.synthetic.gait import Gait
from services.ingest.synthetic.jets import Array, Jet, smooth_step
from services.ingest.synthetic.session import AMPLITUDES
from services.ingest.synthetic.timeline import RESTING_PHASE, Bout, Timeline, time_of

PIVOT_SHORTENING = 0.85
"""Share by which steps are shorter while somebody who stood turns round."""
CLEAR_OF_TURN_S = 1.5
"""s between a turn and a rest."""
_GRID_S = 0.02
_FAR_S = 1e5


@dataclass(frozen=True)
class CorridorTimeline(Timeline):
    """Walks whose steps have sizes: of each bout, in a pivot, and less towards the end."""

    sizes: tuple[float, ...] = ()
    """Amplitude of each bout, as drawn."""
    pivots: tuple[float, ...] = ()
    """s, when a turn from standing begins: in a bout of its own."""
    fades: tuple[float, float, float] = (0.0, 1.0, 0.0)
    """From s, over s, by which share steps get shorter."""

    def amplitude(self, time_s: Array) -> Jet:
        """Of the gait's curves."""
        clock = Jet(time_s, np.ones_like(time_s), np.zeros_like(time_s))
        amplitude = Jet.constant(0.0, time_s)
        stride_s = 1 / self.frequency_hz
        for bout, size in zip(self.bouts, self.sizes, strict=True):
            rise = clock.through(smooth_step(bout.start_s, bout.start_s + stride_s))
            fall = clock.through(smooth_step(bout.end_s - stride_s, bout.end_s))
            amplitude = amplitude + (rise + fall.scaled(-1.0)).scaled(size)
        for start_s, _ in self.turns:
            if start_s not in self.pivots:
                amplitude = amplitude * self._shorter(clock, start_s)
        from_s, over_s, share = self.fades
        return amplitude * clock.shifted(-from_s).scaled(-share / over_s).shifted(1.0)

    def _shorter(self, clock: Jet, start_s: float) -> Jet:
        """In a turn on the way."""
        only = replace(self, bouts=(Bout(-_FAR_S, _FAR_S, 0.0),), turns=((start_s, 0.0),), sizes=())
        return Timeline.amplitude(only, clock.value)


@dataclass
class Walker:
    """Puts bouts, turns and rests one after another; `now_s` and `place_m` are where the session has come to.

    The place is that of the pelvis along the corridor, by the mean speed over a stride.
    """

    timeline: CorridorTimeline
    stride_length: PchipInterpolator
    now_s: float
    place_m: float = 0.0
    turned: float = 0.0  # rad, so far
    bouts: list[Bout] = field(default_factory=list)
    sizes: list[float] = field(default_factory=list)
    turns: list[tuple[float, float]] = field(default_factory=list)
    pivots: list[float] = field(default_factory=list)
    phase: float = RESTING_PHASE

    @classmethod
    def at(cls, start_s: float, timeline: CorridorTimeline, gait: Gait) -> "Walker":
        """Standing at the beginning of the corridor."""
        return cls(timeline, PchipInterpolator(AMPLITUDES, gait.stride_length(AMPLITUDES)), start_s)

    @property
    def planned(self) -> CorridorTimeline:
        """What has been planned so far."""
        return replace(
            self.timeline,
            bouts=tuple(self.bouts), turns=tuple(self.turns), sizes=tuple(self.sizes), pivots=tuple(self.pivots),
        )  # fmt: skip

    def set_out(self, size: float) -> None:
        """Begin a bout that has no end yet."""
        self.bouts.append(Bout(self.now_s, _FAR_S, self.phase))
        self.sizes.append(size)

    def stop(self, wanted_s: float) -> None:
        """End the bout with the whole stride that is nearest to a time."""
        bout, tempo = self.bouts[-1], self.timeline.tempo
        walked = float(tempo.walked(bout.start_s, np.array([wanted_s])).value[0])
        self.stop_after(max(2, round(walked)))

    def stop_after(self, strides: int) -> None:
        """End the bout with so many strides."""
        bout, tempo = self.bouts[-1], self.timeline.tempo
        latest_s = bout.start_s + 4 * strides / tempo.frequency_hz
        self.bouts[-1] = bout._replace(end_s=time_of(tempo, bout.start_s, strides, latest_s))
        self.phase += strides
        self._go_to(self.bouts[-1].end_s)

    def turn_at(self, place_m: float) -> float:
        """When to begin to turn on the way, so that the turn reaches a place."""
        time_s, speed = self._ahead(abs(place_m - self.place_m))
        covered = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * _GRID_S)])
        missing = covered + self._reach_s() * speed - abs(place_m - self.place_m)
        return float(np.interp(0.0, missing, time_s))

    def turn(self, start_s: float, *, pivots: bool = False) -> None:
        """Half a turn, to the left and to the right in turn."""
        angle = math.pi * (-1.0) ** len(self.turns)
        self.turns.append((start_s, angle))
        if pivots:
            self.pivots.append(start_s)
        else:
            self._go_to(start_s + self.timeline.turn_time)

    def length_of(self, strides: int, size: float) -> float:
        """m that so many strides from standing to standing would take the person from now on."""
        ahead = replace(self, bouts=list(self.bouts), sizes=list(self.sizes), turns=list(self.turns))
        ahead.set_out(size)
        ahead.stop_after(strides)
        return abs(ahead.place_m - self.place_m)

    def sized_for(self, length_m: float, strides: int) -> float:
        """Amplitude with which they cover a length."""
        largest = float(AMPLITUDES[-1])
        if self.length_of(strides, largest) <= length_m:
            return largest
        return float(brentq(lambda size: self.length_of(strides, size) - length_m, 0.02, largest, xtol=1e-4))

    def speeds(self, time_s: Array) -> Array:
        """m/s along the corridor at any instants of what has been planned, the first direction positive."""
        planned = self.planned
        walking = np.where(planned.walking(time_s), planned.tempo.walked(0.0, time_s).rate, 0.0)
        lengths = np.asarray(self.stride_length(np.clip(planned.amplitude(time_s).value, 0.0, AMPLITUDES[-1])))
        return np.asarray(lengths * walking * np.cos(planned.heading(time_s).value))

    def _ahead(self, length_m: float) -> tuple[Array, Array]:
        """Instants from now on until a length is certainly covered, and the speed at them."""
        usual = float(self.stride_length(self.sizes[-1])) * self.timeline.frequency_hz
        last_s = self.now_s + 2.5 * length_m / max(usual, 0.05) + 20.0
        time_s = np.arange(self.now_s, last_s, _GRID_S)
        return time_s, np.abs(self.speeds(time_s))

    def _reach_s(self) -> float:
        """s of straight walking that the first half of a turn is worth."""
        span_s = np.linspace(0.0, self.timeline.turn_time / 2, 101)
        one = replace(self.timeline, bouts=(Bout(-_FAR_S, _FAR_S, 0.0),), turns=((0.0, math.pi),), sizes=(1.0,))
        steady = replace(one, fades=(0.0, 1.0, 0.0))
        share = steady.amplitude(span_s).value * np.cos(steady.heading(span_s).value)
        return float(np.trapezoid(share, span_s))

    def _go_to(self, end_s: float) -> None:
        """The place at a later time, by what has been planned."""
        if end_s <= self.now_s:
            return
        time_s = np.linspace(self.now_s, end_s, max(2, math.ceil((end_s - self.now_s) / _GRID_S)))
        self.place_m += float(np.trapezoid(self.speeds(time_s), time_s))
        self.now_s = end_s
