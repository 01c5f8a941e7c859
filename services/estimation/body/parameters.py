"""Every tunable of a session with a camera."""

from dataclasses import dataclass


@dataclass(frozen=True)
class BodyParameters:
    """When a frame is used, a person is followed, and an angle is shown."""

    farthest_m: float = 12.0  # m from the camera; depth cameras see to 5 or 6
    farthest_from_message_s: float = 10.0  # s between a frame and its message; more is a broken time stamp
    stuck_after: int = 30  # identical frames in a row with somebody in them; a second of a real camera never is
    window_s: float = 1.0  # s of standing still that give the posture
    fewest_frames: int = 10  # of such a second
    look_s: float = 0.2  # s between two looks for it
    wait_s: float = 2.5  # s in view after which somebody who does not stand still is followed without
    first_frames: int = 5  # whose median the first posture is then fitted to
    fewest_to_fit: int = 9  # centres of 15 that it needs
    predict_s: float = 0.3  # s without the person in which the filter goes on by itself
    remember_s: float = 12.0  # s of frames that a mark of the operator may lie back; the page offers up to 10 s
    seen_s: float = 0.4  # s for which a centre counts as seen after it was tracked last
    show_after_s: float = 0.3  # s for which an angle must have been observable before it is shown
    hide_after_s: float = 0.15  # s for which it must not have been before it is hidden: the deviation has peaks
    unknown_std: float = 0.5  # rad, rad/s of what is not estimated
    population_quality: float = 0.4  # best quality of a calibration without a standing second, as in walking
