// Left red-orange and solid, right blue and dashed: a convention of gait reports, told apart without colour too.

export const LEFT = "#C44E00";
export const RIGHT = "#0072B2";
export const SIDE_COLOUR = { left: LEFT, right: RIGHT };
export const SIDE_DASH = { left: undefined, right: [7, 4] };
export const INVALID = "#AEB7BD";
export const INK = "#1C2B33";
export const SOFT_INK = "#51626C";
export const GRID = "#E6EBED";
export const PELVIS = "#44606E";
/** Grounds for the parts of a timed test, under ink; each part also bears its name. */
export const PHASE_COLOURS = {
  sit_to_stand: "#D5E3F3",
  walk_out: "#DDEEDF",
  turn: "#FBEBC8",
  walk_back: "#DDEEDF",
  turn_to_sit: "#E6DDF0",
  walk: "#DDEEDF",
  rest: "#E6DDF0",
  run_up: "#E6EBED",
  timed_zone: "#DDEEDF",
  run_out: "#E6EBED",
};
/** Baseline and its MDC, under marks. */
export const CHANGE_BAND = "#E9EDF0";
/** What people like the patient have; nothing is written in it. */
export const REFERENCE_BAND = "#D5DADD";
export const PANEL = "#FFFFFF";
export const GHOST = "#DDE4E7";
/** Another stride beside the person's own: of neither side. */
export const GHOST_INK = "#6A4C93";

/** `#rrggbb` with an alpha for bands. */
export const faint = (colour, alpha) =>
  colour +
  Math.round(alpha * 255)
    .toString(16)
    .padStart(2, "0");
