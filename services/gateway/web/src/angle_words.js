// Why an angle is not shown, in the words of someone who looks at a patient.

const REASONS = {
  hip_internal_rotation: "The thigh's rotation shows only while the knee is bent.",
  shoulder_internal_rotation:
    "The upper arm's rotation shows only while the elbow is bent and the arm is not lifted far to the side.",
  shoulder_flexion: "With the arm lifted far to the side, flexion can not be told from rotation; see arm elevation.",
  ankle_dorsiflexion: "No camera sees feet well enough; the floor tells the ankle while the foot stands flat on it.",
  clavicle_elevation: "The collar bone is too short for a camera to tell shoulder girdle and shoulder apart.",
};
const NOT_SEEN = "The camera has not seen the joints it rests on just now, or not surely enough.";
const OR_NOT_SEEN = "Or the camera has not seen the joints it rests on just now.";

/** Why the angle of that name, without its side, is not observable now. */
export const whyUnseen = (joint) => (REASONS[joint] ? `${REASONS[joint]} ${OR_NOT_SEEN}` : NOT_SEEN);
