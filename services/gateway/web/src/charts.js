// Curves: the last eight seconds while a session runs, mean and spread over the stride afterwards. Degrees here.
import uPlot from "uplot";

import { GRID, PELVIS, SIDE_COLOUR, SIDE_DASH, SOFT_INK, faint } from "./palette.js";
import { degrees, number } from "./units.js";

const SPAN_S = 8;
/** A longer silence is left open, not bridged by a line. */
const GAP_S = 0.5;
const FONT = '12px "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", "Liberation Sans", Arial, sans-serif';
const SIDES = ["left", "right"];

function axis(label, values) {
  return {
    label,
    labelFont: FONT,
    labelSize: 20,
    labelGap: 0,
    font: FONT,
    stroke: SOFT_INK,
    grid: { stroke: GRID, width: 1 },
    ticks: { show: false },
    gap: 6,
    values: (_, splits) => splits.map(values),
  };
}

const plain = (value) => number(value, 0);

/** An angle's name: of a joint of one side, or of what has no side. */
export const angleName = (joint, side) => (side === null ? joint : `${joint}_${side}`);

/** Three series per side: the curve, and its band's upper and lower edge. A side of null is the middle of the body. */
function sidesWithBands(width, sides = SIDES) {
  const series = [{}];
  const bands = [];
  sides.forEach((side, index) => {
    const colour = SIDE_COLOUR[side] ?? PELVIS;
    const edge = { stroke: "transparent", width: 0, points: { show: false } };
    series.push(
      { label: side, stroke: colour, width, dash: SIDE_DASH[side], points: { show: false } },
      { ...edge },
      { ...edge },
    );
    bands.push({ series: [3 * index + 2, 3 * index + 3], fill: faint(colour, 0.14) });
  });
  return { series, bands };
}

/** Keeps the chart as wide and high as its host. */
function fitted(host, options, data) {
  const chart = new uPlot(
    { width: 300, height: 120, legend: { show: false }, cursor: { show: false }, ...options },
    data,
    host,
  );
  const observer = new ResizeObserver(() => {
    if (host.clientWidth > 0 && host.clientHeight > 0)
      chart.setSize({ width: host.clientWidth, height: host.clientHeight });
  });
  observer.observe(host);
  return {
    chart,
    dispose() {
      observer.disconnect();
      chart.destroy();
    },
  };
}

/** A joint of both sides over the last eight seconds, with a band of two standard deviations and the contacts. */
export class RollingChart {
  constructor(host, joint, [low, high], sides = SIDES) {
    this.names = sides.map((side) => angleName(joint, side));
    this.range = [low, high];
    this.at = [];
    this.rows = sides.map(() => ({ value: [], upper: [], lower: [] }));
    this.contacts = [];
    const { series, bands } = sidesWithBands(2, sides);
    this.fit = fitted(
      host,
      {
        series,
        bands,
        padding: [8, 10, 0, 0],
        scales: { x: { time: false, range: [-SPAN_S, 0] }, y: { range: () => this.range } },
        axes: [
          { ...axis("seconds before now", plain), size: 26 },
          { ...axis("degrees", plain), size: 40 },
        ],
        hooks: { draw: [(chart) => this.drawContacts(chart)] },
      },
      [[], ...this.rows.flatMap(() => [[], [], []])],
    );
  }

  /** Poses in the order of their times; older ones than the last are left out, a jump back starts anew. */
  add(poses) {
    for (const pose of poses) {
      const last = this.at[this.at.length - 1];
      if (pose.at_s < last - SPAN_S) this.clear();
      else if (pose.at_s <= last) continue;
      else if (pose.at_s > last + GAP_S) this.append({ at_s: last + GAP_S / 2, angles: {}, angles_std: {} });
      this.append(pose);
    }
    const now = this.at[this.at.length - 1];
    this.forget(now - SPAN_S - 0.2);
    this.draw(now);
  }

  append(pose) {
    this.at.push(pose.at_s);
    this.names.forEach((name, index) => {
      const value = degrees(pose.angles[name]);
      const spread = 2 * (degrees(pose.angles_std[name]) ?? 0);
      this.rows[index].value.push(value);
      this.rows[index].upper.push(value === null ? null : value + spread);
      this.rows[index].lower.push(value === null ? null : value - spread);
      if (value !== null) this.widen(value);
    });
  }

  /** A contact of a foot: a tick with its letter at the foot of the chart; a toe-off: a dotted one. */
  mark(event) {
    this.contacts.push(event);
  }

  clear() {
    this.at.length = 0;
    this.contacts.length = 0;
    for (const row of this.rows) row.value.length = row.upper.length = row.lower.length = 0;
  }

  widen(value) {
    const [low, high] = this.range;
    if (value < low || value > high)
      this.range = [Math.min(low, 10 * Math.floor(value / 10)), Math.max(high, 10 * Math.ceil(value / 10))];
  }

  forget(before) {
    const keepFrom = this.at.findIndex((at) => at >= before);
    if (keepFrom > 0) {
      this.at.splice(0, keepFrom);
      for (const row of this.rows) [row.value, row.upper, row.lower].forEach((values) => values.splice(0, keepFrom));
    }
    this.contacts = this.contacts.filter((contact) => contact.at_s >= before);
  }

  draw(now) {
    this.now = now;
    const columns = this.rows.flatMap((row) => [row.value, row.upper, row.lower]);
    this.fit.chart.setData([this.at.map((at) => at - now), ...columns]);
  }

  drawContacts(chart) {
    const { ctx: pen, bbox } = chart;
    pen.save();
    pen.lineWidth = 1.5 * devicePixelRatio;
    pen.font = `${10 * devicePixelRatio}px sans-serif`;
    pen.textAlign = "center";
    for (const { side, event, at_s } of this.contacts) {
      const x = chart.valToPos(at_s - this.now, "x", true);
      if (x < bbox.left || x > bbox.left + bbox.width) continue;
      const isContact = event === "initial_contact";
      pen.strokeStyle = pen.fillStyle = SIDE_COLOUR[side];
      pen.setLineDash(isContact ? [] : [1.5 * devicePixelRatio, 2 * devicePixelRatio]);
      pen.beginPath();
      pen.moveTo(x, bbox.top + bbox.height);
      pen.lineTo(x, bbox.top + bbox.height - 9 * devicePixelRatio);
      pen.stroke();
      if (isContact) pen.fillText(side === "left" ? "L" : "R", x, bbox.top + bbox.height - 12 * devicePixelRatio);
    }
    pen.restore();
  }

  dispose() {
    this.fit.dispose();
  }
}

/** Mean and one standard deviation of a joint of both legs over 0-100 % of the stride. */
export class MeanChart {
  constructor(host, curves) {
    const { series, bands } = sidesWithBands(2.5);
    const data = [Array.from({ length: 101 }, (_, percent) => percent)];
    for (const side of SIDES) {
      const curve = curves[side];
      const mean = curve ? curve.mean.map(degrees) : data[0].map(() => null);
      const spread = curve ? curve.spread.map(degrees) : data[0].map(() => null);
      data.push(
        mean,
        mean.map((value, i) => (value === null ? null : value + spread[i])),
        mean.map((value, i) => (value === null ? null : value - spread[i])),
      );
    }
    this.fit = fitted(
      host,
      {
        series,
        bands,
        padding: [8, 14, 0, 0],
        scales: { x: { time: false, range: [0, 100] } },
        axes: [
          { ...axis("% of the stride, contact to contact", plain), size: 28 },
          { ...axis("degrees", plain), size: 42 },
        ],
      },
      data,
    );
  }

  dispose() {
    this.fit.dispose();
  }
}
