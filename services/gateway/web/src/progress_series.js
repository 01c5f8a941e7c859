// What the API tells of a patient's progress, put together for drawing: a chart per measure, both sides in it.
import { shown } from "./units.js";

/**
 * Series of one test and measure beside each other; those without any value are left out.
 * @returns {{task: string, instruction: string|null, measure: string, unit: string, series: object[]}[]} in the order told
 */
export function byMeasure(series) {
  const groups = new Map();
  for (const each of series.filter(({ points }) => points.some(({ value }) => value !== null))) {
    const { task, instruction, measure, unit } = each;
    const key = [task, instruction, measure].join(" ");
    if (!groups.has(key)) groups.set(key, { task, instruction, measure, unit, series: [] });
    groups.get(key).series.push(each);
  }
  return [...groups.values()];
}

/** A series as a line in shown units: what counts, what cannot be compared, and what it is held against. */
export function lineOf({ side, measure, unit, visits, points, baseline, mdc }) {
  const { factor } = shown(unit, measure);
  const scale = (value) => (value === null ? null : factor * value);
  const counted = new Set(visits.map(({ visit }) => visit));
  const marks = visits.map(({ visit, value, low, high, change, verdict }) => ({
    number: visit,
    value: scale(value),
    low: scale(low),
    high: scale(high),
    baseline: baseline?.visit === visit,
    real: verdict === "real_change" && change !== null ? Math.sign(change.value) : 0,
    counts: true,
  }));
  for (const { visit, value, low, high } of points)
    if (value !== null && !counted.has(visit))
      marks.push({
        number: visit,
        value: scale(value),
        low: scale(low),
        high: scale(high),
        baseline: false,
        real: 0,
        counts: false,
      });
  marks.sort((a, b) => a.number - b.number);
  return { side, marks, baseline: scale(baseline?.value ?? null), mdc: scale(mdc?.value ?? null) };
}

/** In what visits differ from the baseline, or what nobody said of them: each once, `[visit, rule]` in order. */
export function notAlike(series) {
  const found = new Map();
  for (const { visit, rules } of series.flatMap(({ points }) => points))
    for (const rule of rules)
      if (rule.code === "difference" || rule.code === "unsaid")
        found.set(`${visit} ${rule.code} ${rule.parameters.what}`, [visit, rule]);
  return [...found.values()].sort(([a], [b]) => a - b);
}

/** Treatments in order of their days, each with its letter and its place among the visits (1.5: half-way to the second). */
export function treatmentMarks(treatments, visits) {
  const days = visits.map(({ visit, day }) => [visit, Date.parse(day)]).sort(([a], [b]) => a - b);
  return treatments
    .toSorted((a, b) => a.date.localeCompare(b.date) || a.id - b.id)
    .map((treatment, i) => ({ ...treatment, letter: letterOf(i), at: placeAmong(days, Date.parse(treatment.date)) }));
}

function placeAmong(days, date) {
  const after = days.findIndex(([, day]) => day > date);
  if (after < 0) return (days.at(-1)?.[0] ?? 0) + (days.at(-1)?.[1] === date ? 0 : 0.3);
  if (after === 0) return days[0][0] - 0.3;
  const [[visit, from], [, to]] = [days[after - 1], days[after]];
  return visit + (date - from) / (to - from);
}

const letterOf = (i) => String.fromCharCode(65 + (i % 26)) + (i < 26 ? "" : String(Math.floor(i / 26)));
