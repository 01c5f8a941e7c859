// The skeleton in space. Side view to begin with; drag to look from elsewhere.
import {
  AmbientLight,
  CanvasTexture,
  CircleGeometry,
  CylinderGeometry,
  DirectionalLight,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  PerspectiveCamera,
  PolarGridHelper,
  SRGBColorSpace,
  Scene,
  SphereGeometry,
  Sprite,
  SpriteMaterial,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import { Stage, SIDES, between } from "./figure.js";
import { GHOST, INVALID, PELVIS, SIDE_COLOUR } from "./palette.js";

// Radii in m at the upper and lower end. `bone` names the segment whose validity counts; null is not measured.
const BONES = [
  ...SIDES.flatMap((side) => [
    {
      from: `hip_${side}`,
      to: `knee_${side}`,
      radii: [0.058, 0.042],
      bone: `thigh_${side}`,
      colour: SIDE_COLOUR[side],
    },
    {
      from: `knee_${side}`,
      to: `ankle_${side}`,
      radii: [0.044, 0.026],
      bone: `shank_${side}`,
      colour: SIDE_COLOUR[side],
    },
    { from: `ankle_${side}`, to: `toe_${side}`, radii: [0.026, 0.02], bone: null, colour: GHOST },
    { from: "pelvis_top", to: `hip_${side}`, radii: [0.048, 0.048], bone: "pelvis", colour: PELVIS },
  ]),
  { from: "hip_left", to: "hip_right", radii: [0.048, 0.048], bone: "pelvis", colour: PELVIS },
  { from: "neck", to: "pelvis_top", radii: [0.085, 0.06], bone: null, colour: GHOST },
];
const JOINTS = [
  ...SIDES.flatMap((side) => [
    { at: `hip_${side}`, radius: 0.058, bone: `thigh_${side}`, colour: SIDE_COLOUR[side] },
    { at: `knee_${side}`, radius: 0.0445, bone: `shank_${side}`, colour: SIDE_COLOUR[side] },
    { at: `ankle_${side}`, radius: 0.027, bone: `shank_${side}`, colour: SIDE_COLOUR[side] },
    { at: `toe_${side}`, radius: 0.02, bone: null, colour: GHOST },
  ]),
  { at: "pelvis_top", radius: 0.049, bone: "pelvis", colour: PELVIS },
  { at: "neck", radius: 0.085, bone: null, colour: GHOST },
];
const HEAD = { above_neck_m: 0.2, radius: 0.095 };

const DIRECTIONS = { side: [0, 0.07, 1], front: [1, 0.07, 0], back: [-1, 0.07, 0] };
const LOOK_AT = new Vector3(0, 0.8, 0);
const VIEW_ANGLE_DEG = 30;
const SHOWN_HEIGHT_M = 1.94;
const SHOWN_WIDTH_M = 1.3;
const UP = new Vector3(0, 1, 0);
const FRAME_S = 0.05;

export class Skeleton3d {
  constructor(host) {
    this.host = host;
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    host.append(this.renderer.domElement);
    this.scene = new Scene();
    this.body = new Group();
    this.camera = new PerspectiveCamera(VIEW_ANGLE_DEG, 1, 0.1, 30);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.stage = new Stage();
    this.furnish();
    this.buildBody();
    this.controls.addEventListener("change", () => this.wake());
    this.resizing = new ResizeObserver(() => this.resize());
    this.resizing.observe(host);
  }

  furnish() {
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(2, 5, 4);
    this.scene.add(new AmbientLight(0xffffff, 1.5), sun, this.body);
    const grid = new PolarGridHelper(1.5, 12, 5, 72, 0xd5dde0, 0xd5dde0);
    this.shadow = new Mesh(
      new CircleGeometry(0.26, 40),
      new MeshBasicMaterial({ color: 0x1c2b33, transparent: true, opacity: 0.1, depthWrite: false }),
    );
    this.shadow.rotation.x = -Math.PI / 2;
    this.shadow.position.y = 0.002;
    this.scene.add(grid, this.shadow);
    this.controls.enablePan = false;
    this.controls.minDistance = 1.6;
    this.controls.maxDistance = 8;
    this.controls.maxPolarAngle = Math.PI / 2;
  }

  buildBody() {
    this.bones = BONES.map((bone) => ({
      ...bone,
      mesh: this.solid(new CylinderGeometry(bone.radii[1], bone.radii[0], 1, 24, 1, true), bone),
    }));
    this.joints = JOINTS.map((joint) => ({
      ...joint,
      mesh: this.solid(new SphereGeometry(joint.radius, 24, 18), joint),
    }));
    this.head = this.solid(new SphereGeometry(HEAD.radius, 28, 20), { bone: null, colour: GHOST });
    this.letters = SIDES.map((side) => {
      const sprite = letter(side === "left" ? "L" : "R", SIDE_COLOUR[side]);
      this.body.add(sprite);
      return { side, sprite };
    });
    this.body.visible = false;
  }

  solid(geometry, { bone, colour }) {
    const material = new MeshStandardMaterial({ color: colour, roughness: 0.6 });
    const mesh = new Mesh(geometry, material);
    this.body.add(mesh);
    return mesh;
  }

  /** Side, front or back view. */
  look(from) {
    const height = Math.max(SHOWN_HEIGHT_M, SHOWN_WIDTH_M / this.camera.aspect);
    const distance = height / 2 / Math.tan((VIEW_ANGLE_DEG * Math.PI) / 360);
    this.camera.position
      .set(...DIRECTIONS[from])
      .normalize()
      .multiplyScalar(distance)
      .add(LOOK_AT);
    this.controls.target.copy(LOOK_AT);
    this.controls.update();
    this.wake();
  }

  /** The newest figure; drawn over the next frame's time from where the last one was. */
  show(figure) {
    const now = performance.now() / 1000;
    this.older = this.newer ? this.current(now) : figure;
    this.newer = figure;
    this.since = now;
    this.body.visible = true;
    this.wake();
  }

  /** Grey everything: what is seen is not now. */
  setStale(stale) {
    if (this.stale === stale) return;
    this.stale = stale;
    this.host.classList.toggle("stale", stale);
  }

  dispose() {
    this.resizing.disconnect();
    cancelAnimationFrame(this.frame);
    this.controls.dispose();
    this.scene.traverse((node) => {
      node.geometry?.dispose();
      node.material?.map?.dispose();
      node.material?.dispose();
    });
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.renderer.domElement.remove();
  }

  current(now) {
    return between(this.older, this.newer, Math.min(1, (now - this.since) / FRAME_S));
  }

  wake() {
    this.frame ??= requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.frame = undefined;
    const now = performance.now() / 1000;
    if (this.newer) {
      const figure = this.current(now);
      this.stage.follow(figure, Math.min(0.1, now - (this.drawn ?? now)));
      this.place(figure);
      if (now - this.since < FRAME_S) this.wake();
    }
    this.drawn = now;
    this.renderer.render(this.scene, this.camera);
  }

  place({ points, valid }) {
    // The body is turned back by the slow heading, so that "side" stays side when the patient turns round.
    this.body.rotation.y = -this.stage.heading;
    this.body.position.y = 0.05 - this.stage.ground;
    for (const bone of this.bones) span(bone.mesh, points[bone.from], points[bone.to]);
    for (const joint of this.joints) joint.mesh.position.fromArray(points[joint.at]);
    for (const { bone, mesh, colour } of [...this.bones, ...this.joints]) {
      if (bone !== null) mesh.material.color.set(valid[bone] ? colour : INVALID);
    }
    this.head.position.fromArray(points.neck).y += HEAD.above_neck_m;
    for (const { side, sprite } of this.letters) {
      const [x, y, z] = points[`toe_${side}`];
      sprite.position.set(x + 0.08, y + 0.03, z);
    }
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.framed) this.look("side");
    this.framed = true;
    this.wake();
  }
}

const a = new Vector3();
const b = new Vector3();

function span(mesh, from, to) {
  a.fromArray(from);
  b.fromArray(to);
  mesh.position.copy(a).lerp(b, 0.5);
  const length = a.distanceTo(b);
  mesh.scale.set(1, Math.max(length, 1e-3), 1);
  mesh.quaternion.setFromUnitVectors(UP, b.sub(a).normalize());
}

function letter(text, colour) {
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

/** Whether this browser can draw in space. */
export function canDraw3d() {
  try {
    const context = document.createElement("canvas").getContext("webgl2");
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return context !== null;
  } catch {
    return false;
  }
}
