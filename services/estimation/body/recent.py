"""The last seconds of the person in view, for a start from them and for marks of the operator."""

import base64
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from services.biomech.whole_body.multibody_kinematics import fit_frame
from services.biomech.whole_body.start import (
    Start,
    fitted_start,
    median_centres,
    not_standing,
    standing_start,
)
from services.estimation.body.frames import Frame
from services.estimation.body.parameters import BodyParameters
from services.flow.node import State

Array = NDArray[np.float64]
States = NDArray[np.int64]


class RecentFrames:
    """Frames with somebody in them, of one person, oldest first; those of the last `remember_s`."""

    def __init__(self, parameters: BodyParameters) -> None:
        self._parameters = parameters
        self._frames: list[Frame] = []

    def add(self, frame: Frame) -> None:
        """Take the next frame."""
        self._frames.append(frame)
        oldest_ns = frame.captured_ns - round(self._parameters.remember_s * 1e9)
        if self._frames[0].captured_ns < oldest_ns - 1e9:
            # Once a second: to move a list for every frame costs more.
            self._frames = [each for each in self._frames if each.captured_ns >= oldest_ns]

    def forget(self) -> None:
        """Somebody else is in view, or nobody."""
        self._frames = []

    def since(self, from_ns: int) -> list[Frame]:
        """Frames from a time on."""
        return [frame for frame in self._frames if frame.captured_ns >= from_ns]

    def newest_second(self) -> list[Frame]:
        """Frames of the last `window_s`; none while there are not so many."""
        if not self._frames:
            return []
        frames = self.since(self._frames[-1].captured_ns - round(self._parameters.window_s * 1e9))
        return frames if self._is_enough(frames) else []

    def marked(self, from_ns: int, to_ns: int) -> list[Frame]:
        """Frames of a marked span."""
        return [frame for frame in self._frames if from_ns <= frame.captured_ns <= to_ns]

    def why_not_standing(self, frames: Sequence[Frame]) -> str:
        """In words for a therapist; empty where the frames show a standing, still person."""
        if not self._is_enough(frames):
            seconds = (frames[-1].captured_ns - frames[0].captured_ns) / 1e9 if frames else 0.0
            return f"the person was in view for only {seconds:.2g} s, {self._parameters.window_s:g} s are needed"
        return not_standing(*stacked(frames))

    def _is_enough(self, frames: Sequence[Frame]) -> bool:
        if len(frames) < self._parameters.fewest_frames:
            return False
        # One frame of a second is missing at its end.
        span_s = (frames[-1].captured_ns - frames[0].captured_ns) / 1e9
        return span_s * (1.0 + 1.0 / (len(frames) - 1)) >= 0.95 * self._parameters.window_s

    def snapshot(self) -> State:
        """The frames."""
        return {
            "numbers": [[f.captured_ns, f.body, f.people] for f in self._frames],
            "centres": _pack(np.array([f.centres for f in self._frames]).reshape(-1, 15, 3)),
            "state": ["".join(map(str, f.state)) for f in self._frames],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        rows = zip(state["numbers"], _unpack(state["centres"]), state["state"], strict=True)
        self._frames = [
            Frame(captured_ns, body, people, centres.copy(), np.array([int(level) for level in levels], dtype=np.int64))
            for (captured_ns, body, people), centres, levels in rows
        ]


def _pack(centres: Array) -> str:
    """(n, 15, 3) of single precision as text, to the bit."""
    return base64.b64encode(centres.astype("<f4").tobytes()).decode("ascii")


def _unpack(text: str) -> Array:
    return np.frombuffer(base64.b64decode(text), dtype="<f4").reshape(-1, 15, 3).astype(np.float64)


def stacked(frames: Sequence[Frame]) -> tuple[Array, States]:
    """(t, 15, 3) m, NaN where not seen, and (t, 15)."""
    state = np.array([frame.state for frame in frames])
    centres = np.array([frame.centres for frame in frames])
    return np.where(state[:, :, None] > 0, centres, np.nan), state


def start_from_standing(frames: Sequence[Frame], stature: float | None) -> Start:
    """Of frames that show a standing, still person; stature in m where it is known."""
    return standing_start(*stacked(frames), stature)


def start_from_fit(frames: Sequence[Frame], stature: float | None, fewest_centres: int) -> Start | None:
    """From the posture that fits the median of the frames; None where too few centres were seen."""
    middle = median_centres(*stacked(frames))
    if np.isfinite(middle).all(axis=1).sum() < fewest_centres:
        return None
    fit = fit_frame(middle, np.full(len(middle), 2), stature)
    return fitted_start(fit.q, fit.lengths)
