// The display edge: the only place where radians become degrees and fractions per cent.

const DEGREES = 180 / Math.PI;

/** rad to degrees; null stays null. */
export const degrees = (radians) => (radians === null || radians === undefined ? null : radians * DEGREES);

const PERCENT = { factor: 100, unit: "%", digits: 0 };
const SHOWN = {
  rad: { factor: DEGREES, unit: "°", digits: 1 },
  m: { factor: 1, unit: "m", digits: 2 },
  "m/s": { factor: 1, unit: "m/s", digits: 2 },
  s: { factor: 1, unit: "s", digits: 2 },
  "steps/min": { factor: 1, unit: "steps/min", digits: 0 },
  "m/s/min": { factor: 1, unit: "m/s each minute", digits: 3 },
  "rad/s": { factor: DEGREES, unit: "°/s", digits: 0 },
  "rad/repetition": { factor: DEGREES, unit: "° each time", digits: 2 },
  "repetitions/min": { factor: 1, unit: "/min", digits: 1 },
};

const COUNTS = /^(strides|repetitions|tug_steps|tug_attempts)|_(turns|laps|rests|trials|trials_aborted)$/;

/** How a metric of that unit is shown: factor, unit, digits. Shares of one become per cent. */
export function shown(unit, name) {
  if (name.endsWith("_fraction")) return PERCENT;
  if (name.endsWith("_cv") || name.endsWith("_timing")) return { ...PERCENT, digits: 1 };
  if (COUNTS.test(name)) return { factor: 1, unit: "", digits: 0 };
  if (name.includes("walk_distance")) return { ...SHOWN.m, digits: 1 };
  return SHOWN[unit] ?? { factor: 1, unit: unit === "1" ? "" : unit, digits: 2 };
}

/** A number for the screen with a true minus sign; a dash for what is not known. */
export function number(value, digits) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const text = value.toFixed(digits);
  return (Number(text) === 0 ? text.replace("-", "") : text).replace("-", "−");
}

/** Seconds as 1:05. */
export function clock(seconds) {
  if (seconds === null || seconds === undefined) return "–";
  const whole = Math.max(0, Math.floor(seconds));
  const rest = String(whole % 60).padStart(2, "0");
  const minutes = Math.floor(whole / 60);
  return minutes < 60
    ? `${minutes}:${rest}`
    : `${Math.floor(minutes / 60)}:${String(minutes % 60).padStart(2, "0")}:${rest}`;
}

/** Bytes as kB or MB. */
export function bytes(count) {
  if (count < 1e6) return `${number(count / 1e3, 0)} kB`;
  return `${number(count / 1e6, 1)} MB`;
}

/** A UTC time of the API in the reader's own zone. */
export function when(iso) {
  if (!iso) return "–";
  return new Date(iso).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" });
}
