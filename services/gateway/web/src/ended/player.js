// @ts-check
// The clock of a replay: plays, pauses, goes faster and slower, and waits where there is nothing to show yet.

export const SPEEDS = [0.25, 0.5, 1, 2, 4];
/** After a longer pause of the browser a replay goes on where it was. */
const LONGEST_STEP_S = 0.25;

export class Player {
  at_s = 0;
  speed = 1;
  playing = false;
  waiting = false;

  /**
   * @param {number} end_s
   * @param {{ isReady: (at_s: number) => boolean, onTime: (jumped: boolean) => void, onState: () => void }} told
   */
  constructor(end_s, { isReady, onTime, onState }) {
    this.end_s = end_s;
    this.isReady = isReady;
    this.onTime = onTime;
    this.onState = onState;
    this.frame = 0;
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    if (this.playing) return;
    if (this.at_s >= this.end_s) this.seek(0);
    this.playing = true;
    this.before = performance.now();
    this.onState();
    this.frame = requestAnimationFrame((now) => this.step(now));
  }

  pause() {
    if (!this.playing) return;
    this.playing = this.waiting = false;
    cancelAnimationFrame(this.frame);
    this.onState();
  }

  /** @param {number} at_s */
  seek(at_s) {
    this.at_s = Math.min(this.end_s, Math.max(0, at_s));
    this.onTime(true);
  }

  /** @param {number} now */
  step(now) {
    const elapsed_s = Math.min(LONGEST_STEP_S, Math.max(0, (now - (this.before ?? now)) / 1000));
    this.before = now;
    const next_s = Math.min(this.end_s, this.at_s + elapsed_s * this.speed);
    const wasWaiting = this.waiting;
    this.waiting = !this.isReady(Math.min(next_s, this.end_s - 1e-3));
    if (!this.waiting) this.at_s = next_s;
    this.onTime(false);
    if (this.waiting !== wasWaiting) this.onState();
    if (this.at_s >= this.end_s) this.pause();
    else if (this.playing) this.frame = requestAnimationFrame((then) => this.step(then));
  }

  dispose() {
    cancelAnimationFrame(this.frame);
    this.playing = false;
  }
}
