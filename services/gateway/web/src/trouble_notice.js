// Tells of trouble beyond the page: in the tab's title, and with a quiet sound. Off until somebody asks for it.
import { el } from "./dom.js";
import { recall, remember } from "./screen_memory.js";

const NAME = "trouble";
const FLASH_MS = 1000;
const CHOICES = { page: "Only on this page", title: "In the tab's title", sound: "Title and a quiet sound" };
/** A soft falling third, Hz; the loudness is that of a whisper. */
const TONES = [660, 528];
const TONE_S = 0.22;
const LOUDNESS = 0.04;

export class TroubleNotice {
  constructor() {
    const kept = recall(NAME) ?? "page";
    this.choice = Object.hasOwn(CHOICES, kept) ? kept : "page";
    this.select = el(
      "select",
      { onchange: () => this.choose(this.select.value) },
      ...Object.entries(CHOICES).map(([value, words]) => el("option", { value }, words)),
    );
    this.select.value = this.choice;
    this.node = el("label", { class: "quiet notice-choice" }, "Tell of trouble ", this.select);
    /** @type {Set<string>} */
    this.known = new Set();
    /** @type {AudioContext|null} */
    this.audio = null;
    /** @type {string|null} */
    this.title = null;
    this.calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.timer = setInterval(() => this.flash(), FLASH_MS);
  }

  /** @param {string} choice */
  choose(choice) {
    this.choice = choice;
    remember(NAME, choice);
    if (choice === "sound") this.ring();
    if (choice === "page") this.calmDown();
  }

  /** Who needs a look now, by session. @param {string[]} troubled */
  hear(troubled) {
    const isNew = troubled.some((session) => !this.known.has(session));
    this.known = new Set(troubled);
    if (isNew && this.choice === "sound") this.ring();
    if (troubled.length === 0) this.calmDown();
  }

  flash() {
    if (this.known.size === 0 || this.choice === "page") return;
    if (this.title !== null) {
      if (!this.calm) this.calmDown();
      return;
    }
    this.title = document.title;
    document.title = `(!) ${this.known.size} to look at`;
  }

  calmDown() {
    if (this.title !== null) document.title = this.title;
    this.title = null;
  }

  /** Browsers stay silent until somebody has pressed something on the page; then this does, too. */
  ring() {
    this.audio ??= new AudioContext();
    if (this.audio.state === "suspended") this.audio.resume().catch(() => {});
    const { currentTime, destination } = this.audio;
    TONES.forEach((frequency, place) => {
      const from_s = currentTime + place * TONE_S;
      const [tone, loudness] = [new OscillatorNode(this.audio, { frequency }), new GainNode(this.audio, { gain: 0 })];
      loudness.gain.setValueAtTime(0, from_s);
      loudness.gain.linearRampToValueAtTime(LOUDNESS, from_s + 0.03);
      loudness.gain.linearRampToValueAtTime(0, from_s + TONE_S);
      tone.connect(loudness).connect(destination);
      tone.start(from_s);
      tone.stop(from_s + TONE_S);
    });
  }

  dispose() {
    clearInterval(this.timer);
    this.calmDown();
    this.audio?.close();
  }
}
