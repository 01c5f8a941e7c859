// What is worn decides what a page shows: what can not be known is absent, not empty.
import { SIDES } from "./vectors.js";

/**
 * Sides of which the knee, and little else, is measured: the sensors are on legs alone. Null with a pelvis or trunk.
 * @param {{segment: string}[]} sensors
 */
export function kneesOf(sensors) {
  const worn = new Set(sensors.map((sensor) => sensor.segment));
  if (worn.has("pelvis") || worn.has("torso")) return null;
  const sides = SIDES.filter((side) => worn.has(`thigh_${side}`) && worn.has(`shank_${side}`));
  return sides.length > 0 ? sides : null;
}
