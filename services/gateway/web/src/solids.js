// The solids that the figure in space is made of: bones, joints, letters, a seat, and the fan at a knee.
import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  DoubleSide,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  SRGBColorSpace,
  Sprite,
  SpriteMaterial,
  Vector3,
} from "three";

import { GHOST } from "./palette.js";

const UP = new Vector3(0, 1, 0);

const SEAT = { depth: 0.42, width: 0.4, behind: 0.12 };
const FAN = { edge: 0.162, radius: 0.172, inner: 0.13, outer: 0.205 };

export function solid(geometry, { colour }) {
  return new Mesh(geometry, new MeshStandardMaterial({ color: colour, roughness: 0.6 }));
}

const a = new Vector3();
const b = new Vector3();

/** Lay a mesh of unit height along a line. */
export function span(mesh, from, to) {
  a.fromArray(from);
  b.fromArray(to);
  mesh.position.copy(a).lerp(b, 0.5);
  const length = a.distanceTo(b);
  mesh.scale.set(1, Math.max(length, 1e-3), 1);
  mesh.quaternion.setFromUnitVectors(UP, b.sub(a).normalize());
}

/** A letter that always faces the viewer. */
export function letter(text, colour) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const pen = canvas.getContext("2d");
  pen.font = "700 46px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.fillStyle = colour;
  pen.fillText(text, 32, 34);
  const map = new CanvasTexture(canvas);
  map.colorSpace = SRGBColorSpace;
  const sprite = new Sprite(new SpriteMaterial({ map, depthTest: false, toneMapped: false }));
  sprite.scale.setScalar(0.11);
  return sprite;
}

/** A block to sit on, its top at `height` over the floor. Not measured, so pale. */
export class Seat {
  constructor() {
    this.mesh = solid(new BoxGeometry(SEAT.depth, 1, SEAT.width), { colour: GHOST });
  }

  place(height, hipsAhead) {
    this.mesh.visible = height !== null && height > 0.05;
    if (!this.mesh.visible) return;
    this.mesh.scale.set(1, height, 1);
    this.mesh.position.set(hipsAhead + SEAT.depth / 2 - SEAT.behind, height / 2, 0);
  }
}

/** The angle at a knee as a fan, with a ring where the shank may be within two standard deviations. */
export class Fan {
  constructor(colour) {
    this.open = flat(colour, 0.28);
    this.edge = flat(colour, 0.9);
    this.ring = flat(colour, 0.55);
    this.meshes = [this.open, this.edge, this.ring];
  }

  place(knee, fan) {
    for (const mesh of this.meshes) mesh.visible = fan !== null;
    if (fan === null) return;
    for (const mesh of this.meshes) mesh.position.fromArray(knee);
    reshape(this.open, fan.open, 0, FAN.radius);
    reshape(this.edge, fan.open, FAN.edge, FAN.radius);
    reshape(this.ring, fan.spread, FAN.inner, FAN.outer);
  }
}

function flat(colour, opacity) {
  const material = new MeshBasicMaterial({
    color: colour,
    transparent: true,
    opacity,
    side: DoubleSide,
    depthTest: false,
    depthWrite: false,
  });
  const mesh = new Mesh(new BufferGeometry(), material);
  mesh.renderOrder = 1;
  mesh.frustumCulled = false;
  return mesh;
}

/** A strip between two radii along unit vectors. */
function reshape(mesh, directions, inner, outer) {
  const { geometry } = mesh;
  if (!geometry.index) {
    const corners = directions
      .slice(1)
      .flatMap((_, i) => [2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 1, 2 * i + 3, 2 * i + 2]);
    geometry.setIndex(corners);
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(6 * directions.length), 3));
  }
  const { position } = geometry.attributes;
  directions.forEach(([x, y, z], i) => {
    position.setXYZ(2 * i, x * inner, y * inner, z * inner);
    position.setXYZ(2 * i + 1, x * outer, y * outer, z * outer);
  });
  position.needsUpdate = true;
}
