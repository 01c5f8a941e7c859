// @ts-check
// Keys of programs that read or send here.
import { get, post, remove } from "../api.js";
import { confirmPassword } from "../confirm_password.js";
import { el } from "../dom.js";
import { askForm, showOnce } from "../form_dialog.js";
import { choice, labelled, textInput } from "../form_fields.js";
import { PagedList, chip, moment, row, rowActions, rowButton, rowHead } from "../paged_list.js";
import { when } from "../units.js";
import { frame, newButton } from "./frame.js";

/** @typedef {import("../api_types").Models["KeyOut"]} Key @typedef {import("../api_types").Models["KeyIn"]["role"]} Role */

const ABOUT = "A program that asks Ambula by itself needs a key. It is shown once; make one for each program.";
const LONGEST_DAYS = 365;
/** @type {Record<string, string>} */
const MEANINGS = { service: "Reads and works: starts sessions, exports", viewer: "Only reads" };

/** @param {import("../pages.js").Place} place */
export const open = (place) => new KeysView(place);

class KeysView {
  /** @param {import("../pages.js").Place} place */
  constructor(place) {
    this.list = new PagedList({
      columns: ["For", "May", "Made by", "Made", "Ends", "Last used", "State", "Actions"],
      empty: [
        el("h2", {}, "No keys"),
        el("p", {}, "Make one when a program is to read from here, and give it to that program alone."),
      ],
      read: (part) => get("/keys", part),
      row: (/** @type {Key} */ key) => this.row(key),
    });
    frame(place, "keys", ABOUT, [newButton("New key", () => this.then(createKey()))], this.list.node);
    this.list.refresh();
  }

  /** @param {Key} key */
  row(key) {
    const over = key.revoked !== null || new Date(key.expires) <= new Date();
    return row(
      rowHead(key.name),
      MEANINGS[key.role] ?? key.role,
      key.created_by ?? "account is gone",
      moment(when(key.created)),
      moment(when(key.expires)),
      moment(key.used ? when(key.used) : "never"),
      key.revoked ? chip("Taken back", "none") : over ? chip("Ended", "none") : chip("Valid", "good"),
      over ? el("td") : rowActions(rowButton("Take back", key.name, () => this.then(revokeKey(key)))),
    );
  }

  /** @param {Promise<unknown>} done */
  async then(done) {
    await done;
    this.list.refresh();
  }

  dispose() {}
}

async function createKey() {
  const name = textInput({ required: true, maxlength: 64 });
  const role = choice(Object.entries(MEANINGS), "viewer");
  const days = el("input", { type: "number", required: true, min: 1, max: LONGEST_DAYS, step: 1, value: 90 });
  let text = "";
  const done = await askForm({
    title: "New key",
    fields: [
      labelled("What uses it", name, "For example: hospital export"),
      labelled("May", role),
      labelled("Ends after", days, `Days, at most ${LONGEST_DAYS}.`),
    ],
    action: "Create",
    act: async () => {
      const body = { name: name.value, role: /** @type {Role} */ (role.value), days: Number(days.value) };
      text = (await post("/keys", { body })).key;
    },
  });
  const about = "Give it to the program as a bearer token. It is kept nowhere and not shown again.";
  if (done) await showOnce({ title: `Key for ${name.value}`, about, text });
}

/** @param {Key} key */
const revokeKey = ({ id, name }) =>
  confirmPassword({
    title: `Take back the key for ${name}`,
    about: "The program is refused from now on. A key that was taken back stays so; make a new one if need be.",
    action: "Take it back",
    act: () => remove("/keys/{key}", { key: id }),
  });
