"""The methods side by side: each takes a trial as seen and gives 22 angles per frame."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from services.bench.kinect.camera import offset_std
from services.bench.kinect.motions import Trial
from services.biomech.whole_body.colombel import ColombelCekf
from services.biomech.whole_body.constrained_ekf import OURS, FilterSettings
from services.biomech.whole_body.kernels.tables import COORDINATES, LENGTHS
from services.biomech.whole_body.multibody_kinematics import fit_frame, fit_recording
from services.biomech.whole_body.parameters import START_NOISE, ProcessNoise, StartNoise
from services.biomech.whole_body.start import Start, fitted_start, standing_start
from services.biomech.whole_body.tuning import Recording, replay
from services.ingest.synthetic.whole_body.camera import Seen
from services.ingest.synthetic.whole_body.people import Person
from services.ingest.synthetic.whole_body.programme import RATE_HZ

Array = NDArray[np.float64]

STANDING_FRAMES = 30


@dataclass(frozen=True)
class Watched:
    """One person's trial and how the camera saw it."""

    who: Person
    trial: Trial
    seen: Seen
    kind: str

    @property
    def angles(self) -> Array:
        """(n, 22) rad, the truth."""
        return self.trial.q[:, 3:]


Method = Callable[[Watched], Array]


def published_start(watched: Watched) -> Start:
    """One fitted frame, no prior knowledge of how sure it is: P0 = I (Colombel, section 3.4)."""
    first = fit_frame(watched.seen.centres[0], watched.seen.state[0])
    ones = StartNoise(1.0, 1.0, 1.0, 1.0, 1.0)
    return Start(first.q, np.ones(COORDINATES), first.lengths, np.eye(LENGTHS), None, ones)


def our_start(watched: Watched, *, biased: bool = True) -> Start:
    """A standing second and the stature; the camera's offsets are as large as such cameras have."""
    deviation = offset_std(watched.kind)
    noise = replace(START_NOISE, bias_std=(float(deviation[0]), float(deviation[1]), float(deviation[2])))
    centres, state = watched.seen
    if biased:
        return standing_start(centres[:STANDING_FRAMES], state[:STANDING_FRAMES], watched.who.stature, noise)
    return standing_start(
        centres[:STANDING_FRAMES], state[:STANDING_FRAMES], watched.who.stature, noise
    )._replace(bias_std=None)  # fmt: skip


def recording_of(watched: Watched, start: Start) -> Recording:
    """The trial as tuning takes it."""
    return Recording(watched.seen.centres, watched.seen.state, start, watched.angles, RATE_HZ)


def filtered(settings: FilterSettings, start: Callable[[Watched], Start]) -> Method:
    """A filter of ours."""
    return lambda watched: replay(recording_of(watched, start(watched)), settings)[0]


def printed(process: ProcessNoise) -> Method:
    """Equation 5 as printed."""

    def run(watched: Watched) -> Array:
        ekf = ColombelCekf(published_start(watched), process)
        angles = np.zeros_like(watched.angles)
        with np.errstate(all="ignore"):
            for k, (centres, state) in enumerate(zip(*watched.seen, strict=True)):
                if np.isfinite(ekf.x).all():
                    ekf.advance(1.0 / RATE_HZ if k else 0.0, centres, state)
                angles[k] = ekf.angles
        return angles

    return run


def ours(watched: Watched) -> Array:
    """Ours, the same settings for all tasks."""
    return filtered(OURS, our_start)(watched)


def multibody(watched: Watched) -> Array:
    """Offline: the bounded fit of every frame, after a low-pass without delay."""
    return fit_recording(*watched.seen, RATE_HZ, watched.who.stature)[0][:, 3:]


def raw(watched: Watched) -> Array:
    """Geometry of each frame alone: a fit without memory, low-pass or stature, lengths free."""
    angles = np.zeros_like(watched.angles)
    for k, (centres, state) in enumerate(zip(*watched.seen, strict=True)):
        angles[k] = fit_frame(centres, state).q[3:] if (state > 0).any() else angles[k - 1]
    return angles


def unstarted(watched: Watched) -> Start:
    """Without the standing second: what a fit to the first frames gives."""
    first = fit_frame(np.nanmedian(watched.seen.centres[:STANDING_FRAMES], axis=0), np.full(15, 2))
    return fitted_start(first.q, first.lengths)
