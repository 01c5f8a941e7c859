// Words for how a test was done and for whom results are compared: the same where a session is started and on every page.

export const AIDS = {
  none: "No aid",
  cane: "Cane",
  quad_cane: "Quad cane",
  crutches: "Crutches",
  walking_frame: "Walking frame",
  rollator: "Rollator",
  parallel_bars: "Parallel bars",
  other: "Another aid",
};
export const ORTHOSES = {
  none: "No orthosis",
  ankle_foot: "Ankle-foot orthosis",
  knee_ankle_foot: "Knee-ankle-foot orthosis",
  knee: "Knee orthosis",
  other: "Another orthosis",
};
export const FOOTWEAR = { shoes: "Shoes", socks: "Socks", barefoot: "Barefoot" };
export const ASSISTANCE = { false: "Nobody held the person", true: "Somebody held or supported the person" };
export const PACES = { comfortable: "Comfortable", fast: "As fast as is safe" };
export const STARTS = { standing: "Standing at the line", walking: "Already walking" };

export const SEXES = { female: "Female", male: "Male" };
export const GROUPS = {
  healthy: "Healthy",
  stroke_subacute: "Stroke, subacute",
  stroke_chronic: "Stroke, chronic",
  parkinson: "Parkinson's disease",
  multiple_sclerosis: "Multiple sclerosis",
  spinal_cord_injury: "Spinal cord injury",
  knee_osteoarthritis: "Knee osteoarthritis",
  other: "Another group",
};
export const PARETIC = { left: "Left", right: "Right" };

/** How a test was done, as far as somebody said so; what nobody said is not told. */
export function conditionWords(conditions) {
  if (!conditions) return [];
  const { aid, orthosis, footwear, physical_assistance, speed_instruction, start } = conditions;
  return [
    AIDS[aid],
    ORTHOSES[orthosis],
    FOOTWEAR[footwear],
    physical_assistance ? "with physical assistance" : null,
    speed_instruction ? `Pace: ${PACES[speed_instruction].toLowerCase()}` : null,
    start ? `start: ${STARTS[start].toLowerCase()}` : null,
  ]
    .filter(Boolean)
    .map((words, place) => (place === 0 ? capital(words) : words.toLowerCase()));
}

const capital = (words) => words.charAt(0).toUpperCase() + words.slice(1);
