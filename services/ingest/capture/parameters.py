"""Tunables of live skeletons."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class FollowingParameters:
    """Who is the same person, and who is the patient. Distances are between trunks."""

    alive_s: float = 0.5  # s without a frame of it after which an id no longer proves anything
    jump_m: float = 0.3  # m from where it was heading, in one frame, that an id is believed without a second look
    fastest_m_s: float = 2.0  # m/s, what is added to that per second between two frames
    same_s: float = 2.0  # s for which a vanished person is waited for; occlusions last 0.3 to 3 s
    reach_m: float = 0.5  # m from its way within which a new id may be the vanished person
    reach_growth_m_s: float = 0.2  # m/s by which that grows while it is away
    coasting_s: float = 1.0  # s for which a vanished person is thought to walk on
    size_tolerance: float = 0.15  # median over bones of |log of the ratio|; a single frame scatters by 0.05
    size_memory_s: float = 2.0  # s over which bone lengths are averaged
    decide_s: float = 0.5  # s within which a new id is taken for a vanished person, or is somebody else
    settle_s: float = 1.0  # s at one place before somebody is chosen
    settle_m: float = 0.4  # m that one place is wide
    impatient_s: float = 3.0  # s in view after which somebody who moves about is chosen too
    beside_s: float = 0.5  # s in view together with the patient that make a bystander
    gone_s: float = 10.0  # s without the patient after which a bystander may be chosen
    distance_weight: float = 0.2  # m to the side of the camera's axis that count as much as a metre away from it
    most_people: int = 32  # remembered at a time


FOLLOWING = FollowingParameters()


@dataclass(frozen=True, slots=True)
class CaptureParameters:
    """The port and the session on it. All times in s on the monotonic clock."""

    rate_hz: float = 30.0  # nominal, of both cameras
    first_frame_s: float = 5.0  # for the first frame to come, before a session is refused
    look_s: float = 1.0  # after the first frame: for the floor to be seen
    look_frames: int = 15  # newest frames that say what the camera is and where the floor lies
    sending_s: float = 3.0  # since the last frame, within which a camera counts as sending
    other_sender_s: float = 2.0  # of silence after which another computer may take the port over
    warn_after_s: float = 3.0  # without a frame
    end_after_s: float = 300.0  # without a frame a session ends: long enough to start a computer again
    tick_s: float = 0.02  # between two looks at frames that wait for an earlier one
    most_waiting: int = 3000  # messages kept for a loop that does not fetch them; over a minute


CAPTURE = CaptureParameters()
