// Another stride of the same person, walking along: legs and pelvis, seen through.
import { BackSide, CylinderGeometry, Mesh, MeshBasicMaterial } from "three";

import { BONES } from "./bones.js";
import { between } from "./figure.js";
import { GHOST_INK } from "./palette.js";
import { span } from "./solids.js";

/** A halo around the person's own legs, so that it is seen where both are alike. */
const WIDER = 1.4;
const FRAME_S = 0.05;
const DRAWN = BONES.filter(({ from, to }) => /^(hip|knee|ankle|pelvis_top)/.test(from) && !/^neck/.test(to));

export class Ghost3d {
  /** @param {import("three").Group} body whose turn and place it shares */
  constructor(body) {
    // Only its far side is drawn, so that it never lies over the colours of the person's own legs.
    const look = { color: GHOST_INK, transparent: true, opacity: 0.4, depthWrite: false, side: BackSide };
    const material = new MeshBasicMaterial(look);
    this.bones = DRAWN.map(({ from, to, radii: [upper, lower] }) => {
      const mesh = new Mesh(new CylinderGeometry(lower * WIDER, upper * WIDER, 1, 12, 1, true), material);
      mesh.visible = false;
      return { from, to, mesh };
    });
    body.add(...this.bones.map(({ mesh }) => mesh));
    this.older = this.newer = null;
  }

  /** The newest figure, or null for none. @param {any} figure @param {number} now_s */
  show(figure, now_s) {
    this.older = figure && this.newer ? this.current(now_s) : figure;
    this.newer = figure;
    this.since_s = now_s;
  }

  /** @param {number} now_s */
  current(now_s) {
    const share = Math.min(1, (now_s - this.since_s) / FRAME_S);
    return between(this.older, this.newer, share);
  }

  /** @param {number} now_s */
  place(now_s) {
    const points = this.newer ? this.current(now_s).points : {};
    for (const { from, to, mesh } of this.bones) {
      mesh.visible = from in points && to in points;
      if (mesh.visible) span(mesh, points[from], points[to]);
    }
  }
}
