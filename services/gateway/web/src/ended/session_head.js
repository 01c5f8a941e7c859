// @ts-check
// What stands above everything that is shown of a session that is over.
import { NEVER_CALIBRATED } from "../camera_words.js";
import { conditionWords } from "../condition_words.js";
import { el } from "../dom.js";
import { PatientLink } from "../patient_link.js";
import { clock, number, when } from "../units.js";
import { STORED_WORDS, TASKS, misplacedText } from "../words.js";

/** @param {import("../api_types").Models["SessionOut"]} session */
export function sessionHead(session) {
  const { word, tone } = STORED_WORDS[session.state];
  const task = session.task && session.task !== "walk" ? taskWords(session.task, session.walkway_m) : null;
  const facts = [when(session.started ?? session.created), clock(session.duration_s), task, session.estimator];
  const misplaced = misplacedText(session.misplaced);
  return el(
    "div",
    { class: "report-head" },
    el(
      "div",
      { class: "session-head" },
      el("h1", {}, session.title),
      el("p", { class: "chip big", "data-tone": tone }, word),
      el("span", { class: "spring" }),
      new PatientLink(session).node,
    ),
    el("p", { class: "quiet" }, [...facts, ...conditionWords(session.conditions)].filter(Boolean).join("  ·  ")),
    session.reason ? el("p", { class: "banner" }, session.reason) : null,
    misplaced ? el("p", { class: "banner" }, misplaced) : null,
    session.absolute === false ? el("p", { class: "banner" }, NEVER_CALIBRATED) : null,
  );
}

/** @param {keyof typeof TASKS} task @param {number | null} walkway_m */
function taskWords(task, walkway_m) {
  return walkway_m ? `${TASKS[task]}, ${number(walkway_m, 1)} m` : TASKS[task];
}
