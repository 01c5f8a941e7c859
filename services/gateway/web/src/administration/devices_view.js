// @ts-check
// Sensors and cameras of the clinic.
import { get, patch, post } from "../api.js";
import { el } from "../dom.js";
import { askForm } from "../form_dialog.js";
import { choice, labelled, textInput } from "../form_fields.js";
import { PagedList, chip, moment, row, rowActions, rowButton, rowHead } from "../paged_list.js";
import { when } from "../units.js";
import { frame, newButton } from "./frame.js";

/** @typedef {import("../api_types").Models["DeviceOut"]} Device @typedef {Device["kind"]} Kind */

const ABOUT = "A device that is registered here with its source is offered to no other clinic.";
/** @type {Record<Kind, string>} */
const KINDS = { sensor_set: "Set of sensors", camera: "Camera" };

/** @param {import("../pages.js").Place} place */
export const open = (place) => new DevicesView(place);

class DevicesView {
  /** @param {import("../pages.js").Place} place */
  constructor(place) {
    this.list = new PagedList({
      columns: ["Device", "Kind", "Source", "Note", "State", "Since", "Actions"],
      empty: [
        el("h2", {}, "No devices"),
        el("p", {}, "Register the sets of sensors and the cameras of the clinic, so that sessions say what measured."),
      ],
      read: (part) => get("/devices", part),
      row: (/** @type {Device} */ device) => this.row(device),
    });
    frame(place, "devices", ABOUT, [newButton("New device", () => this.then(createDevice()))], this.list.node);
    this.list.refresh();
  }

  /** @param {Device} device */
  row(device) {
    const { name, retired } = device;
    return row(
      rowHead(name),
      KINDS[device.kind],
      device.source ? el("span", { class: "code" }, device.source) : el("span", { class: "quiet" }, "not said"),
      device.note ?? "",
      retired ? chip(`Not used since ${when(retired)}`, "none") : chip("In use", "good"),
      moment(when(device.created)),
      rowActions(
        rowButton("Change", name, () => this.then(changeDevice(device))),
        rowButton(retired ? "Use again" : "Retire", name, () => this.then(retireDevice(device))),
      ),
    );
  }

  /** @param {Promise<unknown>} done */
  async then(done) {
    await done;
    this.list.refresh();
  }

  dispose() {}
}

/** The sources that cameras and sensors send to; another may be typed. @param {Partial<Device>} device */
async function fieldsOf({ name = "", source = null, note = null }) {
  const offer = await get("/sources").catch(() => null);
  const devices = (offer?.sources ?? []).filter((each) => each.kind === "device");
  const known = el("datalist", { id: "device-sources" }, ...devices.map((each) => el("option", { value: each.id }, each.title)));
  const inputs = {
    name: textInput({ required: true, maxlength: 64, value: name }),
    source: textInput({ maxlength: 297, pattern: "device:\\S+", value: source, list: known.id }),
    note: textInput({ maxlength: 200, value: note }),
  };
  const nodes = [
    labelled("Name", inputs.name, "As it is written on the case"),
    labelled("Source", inputs.source, "Where it sends, for example device:kinect?port=7788; may stay empty"),
    labelled("Note", inputs.note, "About the device, nobody else"),
    known,
  ];
  const read = () => ({ name: inputs.name.value, source: inputs.source.value || null, note: inputs.note.value || null });
  return { nodes, read };
}

async function createDevice() {
  const { nodes, read } = await fieldsOf({});
  const kind = choice(Object.entries(KINDS));
  return askForm({
    title: "New device",
    fields: [labelled("Kind", kind), ...nodes],
    action: "Register",
    act: () => post("/devices", { body: { kind: /** @type {Kind} */ (kind.value), ...read() } }),
  });
}

/** @param {Device} device */
async function changeDevice(device) {
  const { nodes, read } = await fieldsOf(device);
  return askForm({
    title: `Change ${device.name}`,
    fields: nodes,
    action: "Change",
    act: () => patch("/devices/{device}", { device: device.id, body: read() }),
  });
}

/** @param {Device} device */
const retireDevice = ({ id, name, retired }) =>
  askForm({
    title: retired ? `Use ${name} again` : `Retire ${name}`,
    about: retired
      ? "It is offered again, unless its source has been registered for another device meanwhile."
      : "It is not used any more, and its source is free for another device. It stays in the list.",
    fields: [],
    action: retired ? "Use again" : "Retire",
    act: () => patch("/devices/{device}", { device: id, body: { retired: !retired } }),
  });
