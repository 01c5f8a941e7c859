"""Contacts of a leg of which only one segment is known."""

from typing import NamedTuple

from schemas.vocabulary import GaitEventKind
from services.segmentation.gait.swing import Contact, Rotation, SwingDetector


class RotationTiming(NamedTuple):
    """Where the events lie beside the forward rotation of a segment, s, with their deviations."""

    toe_off_before: float
    contact_after: float
    toe_off_std: float
    contact_std: float


class ShankSwingDetector(SwingDetector):
    """Times toe-off and contact by the start and the end of the shank's forward rotation.

    Without thigh and pelvis nobody knows where the ankle is, but the two instants at which the shank's rate passes
    zero lie a nearly constant time after toe-off and before contact, from slow to fast. Contact is known when its
    time has come: no sample after it is needed.
    """

    @property
    def timing(self) -> RotationTiming:
        """The constants of a shank."""
        p = self.parameters
        return RotationTiming(
            p.shank_toe_off_before_swing_s, p.shank_contact_after_swing_s, p.shank_toe_off_std_s, p.shank_contact_std_s
        )

    def _time_toe_off(self, rotation: Rotation) -> Contact:
        toe_off_ns = rotation.start_ns - int(self.timing.toe_off_before * 1e9)
        return Contact(GaitEventKind.TOE_OFF, toe_off_ns, self.timing.toe_off_std)

    def _time_contact(self, captured_ns: int, rotation: Rotation) -> Contact | None:
        contact_ns = rotation.end_ns + int(self.timing.contact_after * 1e9)
        if captured_ns < contact_ns:
            return None
        return Contact(GaitEventKind.INITIAL_CONTACT, contact_ns, self.timing.contact_std)


class FootSwingDetector(ShankSwingDetector):
    """The same for a foot, which turns forward from toe-off until the heel is down, and rests in between."""

    @property
    def timing(self) -> RotationTiming:
        """The constants of a foot."""
        p = self.parameters
        return RotationTiming(
            p.foot_toe_off_before_swing_s, p.foot_contact_after_swing_s, p.foot_toe_off_std_s, p.foot_contact_std_s
        )
