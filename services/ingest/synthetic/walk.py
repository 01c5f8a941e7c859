"""The synthetic walk. Pure."""

from scipy.optimize import brentq

from services.ingest.synthetic.gait import Gait
from services.ingest.synthetic.jets import Array, Jet
from services.ingest.synthetic.parameters import WalkParameters
from services.ingest.synthetic.session import AMPLITUDES, SyntheticSession
from services.ingest.synthetic.timeline import Timeline

COMFORTABLE = WalkParameters()


class SyntheticWalk(SyntheticSession):
    """Quiet standing, then walking at a speed."""

    protocol = "quiet standing, then walking"

    def __init__(self, parameters: WalkParameters = COMFORTABLE) -> None:
        gait = Gait(parameters.thigh_length, parameters.shank_length, parameters.hip_width, parameters.asymmetry)
        super().__init__(parameters, Timeline.plan(parameters), gait)
        self.title = f"Synthetic walk at {parameters.speed:g} m/s (seed {parameters.seed})"
        self.amplitude_of_walk = self._amplitude_at(parameters.speed)
        """Amplitude at which stride length times stride frequency is the speed asked for."""

    def amplitude(self, time_s: Array) -> Jet:
        """Rises over the first stride of a walk and falls over its last, less in a turn."""
        return self.timeline.amplitude(time_s).scaled(self.amplitude_of_walk)

    def _amplitude_at(self, speed: float) -> float:
        wanted = speed / self.timeline.frequency_hz
        longest = float(self.stride_length(AMPLITUDES[-1]))
        if wanted >= longest:
            return float(AMPLITUDES[-1])
        return float(brentq(lambda amplitude: float(self.stride_length(amplitude)) - wanted, 0.0, AMPLITUDES[-1]))
