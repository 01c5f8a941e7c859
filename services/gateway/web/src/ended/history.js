// @ts-check
// What a recording says of the whole session, page by page: strides, contacts, phases, losses, marks, repetitions.
import { get } from "../api.js";

const STRIDES_A_PAGE = 500;

/**
 * @typedef {import("../api_types").Models} Models
 * @typedef {object} Past
 * @property {Models["StrideOut"][]} strides
 * @property {Models["ContactOut"][]} contacts
 * @property {Models["PhaseOut"][]} phases
 * @property {Models["MarkedOut"][]} marks
 * @property {Models["LossOut"][]} losses
 * @property {Models["RepetitionOut"][]} repetitions
 */

/** @returns {Past} */
export const nothingYet = () => ({ strides: [], contacts: [], phases: [], marks: [], losses: [], repetitions: [] });

/** Read all of it, `onMore` after each page. @param {string} session @param {Past} past @param {() => boolean} onMore false: enough */
export async function readPast(session, past, onMore) {
  await Promise.all([readStrides(session, past, onMore), readEvents(session, past, onMore), readTasks(session, past, onMore)]);
}

/** @param {string} session @param {Past} past @param {() => boolean} onMore */
async function readStrides(session, past, onMore) {
  for (let offset = 0; ; offset += STRIDES_A_PAGE) {
    const { total, items } = await get("/sessions/{session}/strides", { session, offset, limit: STRIDES_A_PAGE });
    past.strides.push(...items);
    if (!onMore() || items.length === 0 || offset + items.length >= total) return;
  }
}

/** @param {string} session @param {Past} past @param {() => boolean} onMore */
async function readEvents(session, past, onMore) {
  for (let from_s = 0; ; ) {
    const page = await get("/sessions/{session}/events", { session, from_s });
    past.contacts.push(...page.contacts);
    past.marks.push(...page.marks);
    past.losses = joined(past.losses, page.losses, page.from_s);
    if (!onMore() || page.next_s === null) return;
    from_s = page.next_s;
  }
}

/** @param {string} session @param {Past} past @param {() => boolean} onMore */
async function readTasks(session, past, onMore) {
  const [phases, repetitions] = await Promise.all([
    get("/sessions/{session}/phases", { session }).catch(() => ({ phases: [] })),
    get("/sessions/{session}/repetitions", { session }).catch(() => ({ repetitions: [] })),
  ]);
  past.phases = phases.phases;
  past.repetitions = repetitions.repetitions;
  onMore();
}

/**
 * Losses of one page and the next: one that goes on at the end of a page is the one that the next page begins with.
 * @param {Models["LossOut"][]} before @param {Models["LossOut"][]} after @param {number} from_s where the second page begins
 */
export function joined(before, after, from_s) {
  const isOpen = (/** @type {Models["LossOut"]} */ each) => each.end_s === null;
  const kept = before.map((loss) => {
    if (!isOpen(loss)) return loss;
    const rest = after.find(({ source, kind, start_s }) => source === loss.source && kind === loss.kind && start_s <= from_s);
    return { ...loss, end_s: rest ? rest.end_s : from_s };
  });
  const isRest = (/** @type {Models["LossOut"]} */ { source, kind, start_s }) =>
    start_s <= from_s && before.some((loss) => isOpen(loss) && loss.source === source && loss.kind === kind);
  return [...kept, ...after.filter((loss) => !isRest(loss))];
}
