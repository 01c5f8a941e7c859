// Vectors of three numbers, and the sides of a body.

export const SIDES = ["left", "right"];

export const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (a, factor) => a.map((value) => value * factor);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const unit = (a) => times(a, 1 / Math.max(1e-9, Math.hypot(...a)));
export const middle = (a, b) => times(plus(a, b), 0.5);
