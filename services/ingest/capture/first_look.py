"""What a camera is, where it stands and where the floor lies, by its first frames."""

import time

import numpy as np

from schemas.session import Anthropometry
from services.ingest.camera_checks import check_view
from services.ingest.capture.datagram import CameraFrame
from services.ingest.capture.parameters import CaptureParameters
from services.ingest.capture.port import Arrival, CapturePort
from services.ingest.errors import SourceError, WrongAxes
from services.ingest.manifest import TYPICAL_BODY
from services.ingest.skeleton import CameraView, plane_of_floor, view_of
from services.ingest.skeleton.vendors import VENDORS
from services.ingest.units import scale_to_si


class NothingArrives(SourceError):
    """No frame came in time."""


def first_look(port: CapturePort, parameters: CaptureParameters) -> list[Arrival]:
    """The newest frames of a camera that sends. Raises NothingArrives after a while, saying what did arrive."""
    give_up_s = time.monotonic() + parameters.first_frame_s
    while not (seen := port.recent()):
        if time.monotonic() >= give_up_s:
            complaint = port.complaint()
            wrong = f"; the last datagram was refused: {complaint}" if complaint is not None else ""
            raise NothingArrives(
                f"no frame of a Kinect came to port {port.port} within {parameters.first_frame_s:g} s{wrong}. Start "
                "the sender on the capture PC, and check its address and port and AMBULA_SKELETON_HOST here"
            )
        time.sleep(parameters.tick_s)
    enough_s = time.monotonic() + parameters.look_s
    while len(seen) < parameters.look_frames and time.monotonic() < enough_s:
        time.sleep(parameters.tick_s)
        seen = port.recent() or seen
    return seen


def view_of_frames(frames: list[CameraFrame]) -> tuple[CameraView, float | None]:
    """How the camera looks into the room, and the height of the floor, m: by the median of what its frames say.

    A frame's `up` stands over its floor. Without either the camera stands level. Raises WrongAxes, or WrongUnits for
    a person that is none in the camera's unit.
    """
    kind = frames[-1].camera
    metres = scale_to_si("length", VENDORS[kind].unit)
    frames = [frame for frame in frames if frame.camera is kind]
    try:
        # All zeros is how a Kinect says that it sees no floor.
        planes = [plane_of_floor(each.floor, metres) for each in frames if each.floor is not None and any(each.floor)]
        ups = [list(frame.up) for frame in frames if frame.up is not None] or [up for up, _ in planes]
        view = view_of(kind, up=np.median(ups, axis=0).tolist() if ups else None)
    except WrongAxes as error:
        raise WrongAxes(f"what the capture PC sends as `up` or `floor`: {error}") from error
    bodies = [body for frame in frames for body in frame.bodies]
    if bodies:
        positions, codes = np.stack([body.positions for body in bodies]), np.stack([body.codes for body in bodies])
        check_view("what the capture PC sends", view, positions, codes, VENDORS[kind].unit)
    return view, float(np.median([height for _, height in planes])) if planes else None


def body_of(height_m: float | None) -> Anthropometry:
    """Mean lengths of people of that height, m, or of adults."""
    if height_m is None:
        return TYPICAL_BODY.described()
    # The body's model brings a compiler along, which an ingest without such a session does without.
    from services.biomech.whole_body.parameters import STATURE_SHARE

    return Anthropometry(
        height_m=height_m,
        mass_kg=None,
        thigh_length_m=height_m * STATURE_SHARE["thigh"],
        shank_length_m=height_m * STATURE_SHARE["shank"],
        hip_width_m=2 * height_m * STATURE_SHARE["half_pelvis"],
        source="regression",
    )
