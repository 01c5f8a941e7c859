"""The synthetic walk. Pure."""

from services.ingest.errors import InvalidOption
from services.ingest.synthetic.gait import Gait
from services.ingest.synthetic.jets import Array, Jet
from services.ingest.synthetic.parameters import WalkParameters
from services.ingest.synthetic.session import SyntheticSession
from services.ingest.synthetic.timeline import Timeline

COMFORTABLE = WalkParameters()


class SyntheticWalk(SyntheticSession):
    """Quiet standing, then walking at a speed."""

    protocol = "quiet standing, then walking"

    def __init__(self, parameters: WalkParameters = COMFORTABLE) -> None:
        if parameters.camera and parameters.turn_every:
            raise InvalidOption("turn_every: a camera sees a walker from the front; leave out turns or camera")
        gait = Gait(parameters.thigh_length, parameters.shank_length, parameters.hip_width, parameters.asymmetry)
        super().__init__(parameters, Timeline.plan(parameters), gait)
        self.title = f"Synthetic walk at {parameters.speed:g} m/s (seed {parameters.seed})"
        self.amplitude_of_walk = self.amplitude_at(parameters.speed)
        """Amplitude at which stride length times stride frequency is the speed asked for."""

    def amplitude(self, time_s: Array) -> Jet:
        """Rises over the first stride of a walk and falls over its last, less in a turn."""
        return self.timeline.amplitude(time_s).scaled(self.amplitude_of_walk)
