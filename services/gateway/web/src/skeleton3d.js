// The figure in space. Side view to begin with; drag to look from elsewhere.
import {
  AmbientLight,
  CircleGeometry,
  CylinderGeometry,
  DirectionalLight,
  Group,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  PolarGridHelper,
  Scene,
  SphereGeometry,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import { BONES, HEAD_RADIUS_M, JOINTS } from "./bones.js";
import { Ghost3d } from "./ghost3d.js";
import { KneeLabels } from "./knee_labels.js";
import { between, kneeFan } from "./figure.js";
import { GHOST, INVALID, SIDE_COLOUR } from "./palette.js";
import { Fan, Seat, letter, solid, span } from "./solids.js";
import { Stage } from "./stage.js";
import { SIDES } from "./vectors.js";

const DIRECTIONS = { side: [0, 0.07, 1], front: [1, 0.07, 0], back: [-1, 0.07, 0], mirror: [1, 0.07, 0] };
const VIEW_ANGLE_DEG = 30;
/** What fits into the picture: a body, one that lifts its arms in a room, or legs alone, which need more width to be
 * stretched out in sitting. m */
const FRAMES = {
  body: { height: 1.94, width: 1.3, middle: 0.8, seatedWidth: 1.3, seatedRise: 0 },
  room: { height: 2.1, width: 1.66, middle: 0.92, seatedWidth: 1.66, seatedRise: 0 },
  legs: { height: 1.2, width: 1.18, middle: 0.46, seatedWidth: 1.28, seatedRise: 0.13 },
};
const FRAME_S = 0.05;

export class Skeleton3d {
  constructor(host) {
    this.host = host;
    this.renderer = new WebGLRenderer({ antialias: !drawsInSoftware(), alpha: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    host.append(this.renderer.domElement);
    this.labels = new KneeLabels(host);
    this.scene = new Scene();
    this.body = new Group();
    this.camera = new PerspectiveCamera(VIEW_ANGLE_DEG, 1, 0.1, 30);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.stage = new Stage();
    this.frameOf = FRAMES.body;
    this.view = "side";
    this.furnish();
    this.buildBody();
    this.ghost = new Ghost3d(this.body);
    this.controls.addEventListener("change", () => this.wake());
    this.resizing = new ResizeObserver(() => this.resize());
    this.resizing.observe(host);
  }

  furnish() {
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(2, 5, 4);
    this.scene.add(new AmbientLight(0xffffff, 1.5), sun, this.body);
    const grid = new PolarGridHelper(1.5, 12, 5, 72, 0xd5dde0, 0xd5dde0);
    const shadow = new Mesh(
      new CircleGeometry(0.26, 40),
      new MeshBasicMaterial({ color: 0x1c2b33, transparent: true, opacity: 0.1, depthWrite: false }),
    );
    shadow.rotation.x = -Math.PI / 2;
    shadow.position.y = 0.002;
    this.seat = new Seat();
    this.seat.mesh.visible = false;
    this.scene.add(grid, shadow, this.seat.mesh);
    this.controls.enablePan = false;
    this.controls.minDistance = 1.6;
    this.controls.maxDistance = 8;
    this.controls.maxPolarAngle = Math.PI / 2;
  }

  buildBody() {
    this.bones = BONES.map((bone) => ({
      ...bone,
      mesh: solid(new CylinderGeometry(bone.radii[1], bone.radii[0], 1, 24, 1, true), bone),
    }));
    this.joints = JOINTS.map((joint) => ({
      ...joint,
      mesh: solid(new SphereGeometry(joint.radius, 24, 18), joint),
    }));
    this.head = solid(new SphereGeometry(HEAD_RADIUS_M, 28, 20), { colour: GHOST });
    this.letters = SIDES.map((side) => ({ side, sprite: letter(side === "left" ? "L" : "R", SIDE_COLOUR[side]) }));
    this.fans = SIDES.map((side) => ({ side, fan: new Fan(SIDE_COLOUR[side]) }));
    this.body.add(
      ...[...this.bones, ...this.joints].map(({ mesh }) => mesh),
      this.head,
      ...this.letters.map(({ sprite }) => sprite),
      ...this.fans.flatMap(({ fan }) => fan.meshes),
    );
    this.body.visible = false;
  }

  /** Side, front or back view, or the front as the patient sees herself in a mirror. */
  look(from) {
    this.view = from;
    const { middle } = this.frameOf;
    const shown = this.shownHeight(this.frameOf.width);
    const distance = shown / 2 / Math.tan((VIEW_ANGLE_DEG * Math.PI) / 360);
    const target = new Vector3(0, middle, 0);
    const [x, y, z] = DIRECTIONS[from];
    this.camera.position
      .set(x, y, z)
      .normalize()
      .multiplyScalar(distance)
      .add(target);
    this.controls.target.copy(target);
    this.controls.update();
    this.wake();
  }

  shownHeight(width) {
    return Math.max(this.frameOf.height, width / this.camera.aspect);
  }

  /** A leg that sits is wider and lower than one that stands. */
  zoom() {
    const { width, seatedWidth, seatedRise } = this.frameOf;
    const seated = this.shownHeight(width) / this.shownHeight(seatedWidth);
    this.camera.zoom = 1 + (seated - 1) * this.stage.sitting;
    this.scene.position.y = seatedRise * this.stage.sitting;
    this.camera.updateProjectionMatrix();
  }

  /** The newest figure, drawn over the next frame's time from where the last one was. `angles` are of its knees, rad;
   * `ghost` is another stride's figure. */
  show(figure, angles = {}, ghost = null) {
    const now = performance.now() / 1000;
    this.ghost.show(ghost, now);
    const frame = figure.inRoom ? FRAMES.room : figure.whole ? FRAMES.body : FRAMES.legs;
    if (frame !== this.frameOf) {
      this.frameOf = frame;
      this.look(this.view);
    }
    this.older = this.newer ? this.current(now) : figure;
    this.newer = figure;
    this.angles = angles;
    this.since = now;
    this.body.visible = true;
    this.wake();
  }

  /** Nobody is there. */
  clear() {
    if (!this.newer) return;
    this.newer = this.older = null;
    this.body.visible = false;
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
    this.scene.traverse((/** @type {any} */ node) => {
      node.geometry?.dispose();
      node.material?.map?.dispose();
      node.material?.dispose();
    });
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.renderer.domElement.remove();
    this.labels.dispose();
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
    const figure = this.newer && this.current(now);
    if (figure) {
      this.stage.follow(figure, Math.min(0.1, now - (this.drawn ?? now)));
      this.place(figure);
      this.ghost.place(now);
      this.zoom();
      if (now - this.since < FRAME_S) this.wake();
    }
    this.drawn = now;
    this.renderer.render(this.scene, this.camera);
    if (figure) this.labels.show(figure, this.angles, (point) => this.onScreen(point));
  }

  place(figure) {
    const { points, valid } = figure;
    // The body is turned back by the slow heading, so that "side" stays side when the patient turns round.
    this.body.rotation.y = -this.stage.heading;
    this.body.scale.z = this.view === "mirror" ? -1 : 1;
    const [x, z] = this.stage.standpoint;
    this.body.position.set(-this.stage.centre - x, 0.05 - this.stage.ground, -z * this.body.scale.z);
    this.seat.place(this.stage.seatHeight(figure), -this.stage.centre);
    for (const { mesh, from, to } of this.bones) {
      mesh.visible = from in points && to in points;
      if (mesh.visible) span(mesh, points[from], points[to]);
    }
    for (const { mesh, at } of this.joints) {
      mesh.visible = at in points;
      if (mesh.visible) mesh.position.fromArray(points[at]);
    }
    for (const { bone, mesh, colour } of [...this.bones, ...this.joints]) {
      if (bone !== null) mesh.material.color.set(valid[bone] ? colour : INVALID);
    }
    this.head.visible = "head" in points;
    if (this.head.visible) this.head.position.fromArray(points.head);
    for (const { side, sprite } of this.letters) {
      sprite.visible = `letter_${side}` in points;
      if (sprite.visible) sprite.position.fromArray(points[`letter_${side}`]);
    }
    for (const { side, fan } of this.fans) {
      const angle = figure.whole ? undefined : this.angles[side];
      fan.place(points[`knee_${side}`], angle ? kneeFan(figure, side, angle.std) : null);
    }
  }

  /** Place of a point of the body on the screen, in px from the upper left corner. */
  onScreen(point) {
    const place = new Vector3().fromArray(point).applyMatrix4(this.body.matrixWorld).project(this.camera);
    return [((place.x + 1) / 2) * this.host.clientWidth, ((1 - place.y) / 2) * this.host.clientHeight];
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.framed) this.look(this.view);
    this.framed = true;
    this.wake();
  }
}

/** Ask a context of its own something, and give it back. @template T @param {(context: WebGL2RenderingContext|null) => T} question */
function asked(question) {
  const context = document.createElement("canvas").getContext("webgl2");
  try {
    return question(context);
  } finally {
    context?.getExtension("WEBGL_lose_context")?.loseContext();
  }
}

/** Whether this browser can draw in space. */
export function canDraw3d() {
  try {
    return asked((context) => context !== null);
  } catch {
    return false;
  }
}

/** Whether no graphics card helps: smooth edges then cost three of four pictures per second. */
function drawsInSoftware() {
  return asked((context) => {
    const details = context?.getExtension("WEBGL_debug_renderer_info");
    const name = details ? context?.getParameter(details.UNMASKED_RENDERER_WEBGL) : "";
    return /swiftshader|llvmpipe|software|basic render/i.test(String(name));
  });
}
