// What cameras do and what their angles rest on, in the words of someone who looks at a patient.

/** Depth cameras. */
export const CAMERAS = { kinect_v2: "Kinect v2", azure_kinect: "Azure Kinect", other: "Depth camera" };

/** What a camera's state means to a therapist. */
export function cameraWord({ state, people }) {
  if (state === "missing") return { word: "No pictures", tone: "lost" };
  if (state === "stuck") return { word: "Picture stands still", tone: "check" };
  if (state === "unused") return { word: "Not used", tone: "done" };
  if (people === 0) return { word: "Nobody in view", tone: "check" };
  if (people > 1) return { word: `${people} people in view`, tone: "check" };
  if (state === "rejected") return { word: "Partly covered", tone: "check" };
  if (state === "calibrating") return { word: "Calibrating", tone: "wait" };
  return { word: "Good", tone: "good" };
}

/** A second person in view is no trouble by itself: one is followed. */
export const seesNobody = ({ state, people }) =>
  ["missing", "stuck", "rejected"].includes(state) || (people === 0 && state !== "unused");

/** What to do about angles that refer to no known posture, and what it means afterwards. */
export const UNCALIBRATED = "Angles are uncalibrated: stand upright and still for a second.";
export const NEVER_CALIBRATED =
  "Angles are not calibrated: nobody was seen to stand still for a second, so each may be off by a constant." +
  " Ranges, times and counts do not depend on it.";
