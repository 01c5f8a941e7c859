// Where the figure stands and how it is turned for the eye: slow, so that the view stays calm.
import { thighTilt } from "./figure.js";
import { floorUnder, standpointOf } from "./room_figure.js";
import { minus } from "./vectors.js";

const RADIANS = Math.PI / 180;
const SITS = { from: 55 * RADIANS, until: 42 * RADIANS };
const SEAT_UNDER_HIP_M = 0.07;
/** Height of an ankle's joint centre over the floor, as drawn and in a room. */
const ANKLE_M = { drawn: 0.05, inRoom: 0.09 };
/** How far a person may step before the view goes along. */
const LEEWAY_M = 0.15;

const share = (elapsed_s, slowness_s) => 1 - Math.exp(-elapsed_s / slowness_s);
const ramp = (value, low, high) => Math.min(1, Math.max(0, (value - low) / (high - low)));
const turned = ([x, , z], heading) => x * Math.cos(heading) - z * Math.sin(heading);

/** Follows the floor, the direction of walking, and whether the person sits. */
export class Stage {
  constructor() {
    this.heading = null;
    this.ground = null;
    this.centre = 0;
    /** Where a body in a room stands: x, z. */
    this.standpoint = [0, 0];
    this.seated = false;
    /** 0 standing, 1 sitting, smooth: how far the view has gone over to the other. */
    this.sitting = 0;
  }

  follow(figure, elapsed_s) {
    if (figure.inRoom) {
      this.followInRoom(figure, elapsed_s);
      return;
    }
    const tilt = thighTilt(figure);
    const floor = floorOf(figure, tilt);
    const centre = figure.whole ? 0 : centreOf(figure);
    if (this.heading === null) {
      this.heading = figure.heading;
      this.ground = floor;
      this.centre = centre;
      this.sitting = Number(tilt > SITS.from);
    }
    const turn = Math.atan2(Math.sin(figure.heading - this.heading), Math.cos(figure.heading - this.heading));
    this.heading += turn * share(elapsed_s, 0.8);
    this.centre += (centre - this.centre) * share(elapsed_s, 0.8);
    this.seated = tilt > (this.seated ? SITS.until : SITS.from);
    this.sitting += (Number(this.seated) - this.sitting) * share(elapsed_s, 0.5);
    // Down at once, up slowly, so that a foot never sinks into the floor and a swinging leg does not lift it.
    // With the thigh as in sitting down, up quickly.
    const slowness_s = 4 - 3.75 * ramp(tilt, 35 * RADIANS, 60 * RADIANS);
    this.ground = floor < this.ground ? floor : this.ground + (floor - this.ground) * share(elapsed_s, slowness_s);
  }

  /** A camera sees feet roughly: floor and place are followed slowly, either way. */
  followInRoom(figure, elapsed_s) {
    const first = this.heading === null;
    this.heading = figure.heading;
    const floor = floorUnder(figure, ANKLE_M.inRoom) + ANKLE_M.drawn;
    this.ground = first ? floor : this.ground + (floor - this.ground) * share(elapsed_s, 1.5);
    this.standpoint = standpointOf(figure).map((place, axis) => {
      if (first) return place;
      const beyond = place - this.standpoint[axis];
      const drag = Math.sign(beyond) * Math.max(0, Math.abs(beyond) - LEEWAY_M);
      return this.standpoint[axis] + drag + (beyond - drag) * share(elapsed_s, 3);
    });
  }

  /** Height of the seat over the floor; null while the person does not sit. */
  seatHeight({ points, sides }) {
    if (!this.seated) return null;
    return Math.min(...sides.map((side) => points[`hip_${side}`][1])) - SEAT_UNDER_HIP_M - this.ground + 0.05;
  }
}

/** The lowest ankle; for legs alone, the more they sit, the foot under the knee, also while the leg is stretched out. */
function floorOf({ points, sides, whole }, tilt) {
  const lowest = Math.min(...sides.map((side) => points[`ankle_${side}`][1]));
  if (whole) return lowest;
  const below = sides.map((side) => {
    const shank = minus(points[`knee_${side}`], points[`ankle_${side}`]);
    return points[`knee_${side}`][1] - Math.hypot(...shank);
  });
  const sitting = ramp(tilt, 45 * RADIANS, 65 * RADIANS);
  return lowest + (Math.min(...below) - lowest) * sitting;
}

function centreOf({ points, sides, heading }) {
  const ahead = sides.flatMap((side) =>
    ["hip", "knee", "ankle", "toe"].map((joint) => turned(points[`${joint}_${side}`], heading)),
  );
  return (Math.min(...ahead) + Math.max(...ahead)) / 2;
}
