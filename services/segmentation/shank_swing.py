"""Contacts of a leg of which only the shank is known."""

from schemas.vocabulary import GaitEventKind
from services.segmentation.swing import Contact, Rotation, SwingDetector


class ShankSwingDetector(SwingDetector):
    """Times toe-off and contact by the start and the end of the shank's forward rotation.

    Without thigh and pelvis nobody knows where the ankle is, but the two instants at which the shank's rate passes
    zero lie a nearly constant time after toe-off and before contact, from slow to fast. Contact is known when its
    time has come: no sample after it is needed.
    """

    def _time_toe_off(self, rotation: Rotation) -> Contact:
        p = self.parameters
        toe_off_ns = rotation.start_ns - int(p.shank_toe_off_before_swing_s * 1e9)
        return Contact(GaitEventKind.TOE_OFF, toe_off_ns, p.shank_toe_off_std_s)

    def _time_contact(self, captured_ns: int, rotation: Rotation) -> Contact | None:
        p = self.parameters
        contact_ns = rotation.end_ns + int(p.shank_contact_after_swing_s * 1e9)
        if captured_ns < contact_ns:
            return None
        return Contact(GaitEventKind.INITIAL_CONTACT, contact_ns, p.shank_contact_std_s)
