// A live connection that comes back by itself, within two seconds of the gateway being there again.

import { signedOut } from "./api.js";

const FIRST_WAIT_MS = 250;
const LONGEST_WAIT_MS = 1500;
const SILENCE_MS = 4000;
/** A gateway that is too busy to answer within the first silence must not be asked again and again without an end. */
const LONGEST_SILENCE_MS = 16000;

const NOT_LIVE = 4404;
const NORMAL = 1000;
const SIGNED_OUT = 4401;

/** Calls `onMessage` with each message, `onState(open)` when the line comes or goes, `onEnd` when nothing more will come. */
export class LiveSocket {
  /**
   * @param {string} path
   * @param {{ onMessage: (message: any) => void, onState?: (open: boolean) => void, onEnd?: () => void }} told
   */
  constructor(path, { onMessage, onState = (_open) => {}, onEnd = () => {} }) {
    this.path = path;
    this.onMessage = onMessage;
    this.onState = onState;
    this.onEnd = onEnd;
    this.wait = FIRST_WAIT_MS;
    this.patience = SILENCE_MS;
    this.closed = false;
    this.open();
  }

  open() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}/v1/live${this.path}`);
    this.socket = socket;
    this.watchSilence();
    socket.onopen = () => {
      this.wait = FIRST_WAIT_MS;
      this.watchSilence(this.patience);
      this.onState(true);
    };
    socket.onmessage = (event) => {
      this.patience = SILENCE_MS;
      this.watchSilence();
      this.onMessage(JSON.parse(event.data));
    };
    socket.onclose = (event) => this.lost(socket, event.code);
  }

  lost(socket, code) {
    if (this.closed || socket !== this.socket) return;
    clearTimeout(this.silence);
    this.socket = null;
    if (code === NOT_LIVE || code === NORMAL) {
      this.close();
      this.onEnd();
      return;
    }
    this.onState(false);
    if (code === SIGNED_OUT) {
      this.close();
      signedOut();
      return;
    }
    this.timer = setTimeout(() => this.open(), this.wait);
    this.wait = Math.min(this.wait * 2, LONGEST_WAIT_MS);
  }

  // A cable that was pulled closes nothing: the gateway speaks twice a second, so longer silence means a dead line.
  watchSilence(patience_ms = SILENCE_MS) {
    clearTimeout(this.silence);
    const socket = this.socket;
    this.silence = setTimeout(() => {
      this.patience = Math.min(2 * patience_ms, LONGEST_SILENCE_MS);
      socket.close();
      this.lost(socket, 1006);
    }, patience_ms);
  }

  close() {
    this.closed = true;
    clearTimeout(this.timer);
    clearTimeout(this.silence);
    this.socket?.close();
  }
}
