// How far a number may be relied on, and what speaks against it.

export const GRADES = {
  good: { word: "Good", tone: "good" },
  fair: { word: "Fair", tone: "check" },
  poor: { word: "Poor", tone: "check" },
  withheld: { word: "Withheld", tone: "lost" },
};

const DOUBTS = {
  few_cycles: "few cycles",
  not_observed: "not observed",
  coverage: "not seen all the time",
  rejected_cycles: "many cycles left out",
  loss: "samples lost",
  silence: "a sensor was silent",
  late: "samples came too late",
  misplaced: "sensors may be swapped",
  not_calibrated: "not calibrated",
  not_absolute: "unknown constant in the angle",
  not_locked: "rhythm not locked",
  warm_up: "from the warm-up",
  wide_interval: "wide interval",
  weak_measure: "weak measure with these sensors",
  implausible: "implausible",
  not_positive: "not positive",
  conditions_unsaid: "conditions not said",
};

/** Reasons for less than full trust, the weightiest first. */
export function doubtWords({ doubts, withheld_because }) {
  if (withheld_because) return withheld_because;
  return doubts.map(({ kind, subject }) => [DOUBTS[kind] ?? kind.replaceAll("_", " "), subject && `(${subjectName(subject)})`])
    .map((parts) => parts.filter(Boolean).join(" "))
    .join(", ");
}

const subjectName = (subject) => subject.replaceAll("_", " ");
