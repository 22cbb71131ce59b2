// What happens at the handle: the user's force as an arrow, the rubber band to the dragged target.

import {
  ConeGeometry,
  CylinderGeometry,
  Group,
  Mesh,
  MeshStandardMaterial,
  SphereGeometry,
  Vector3,
} from "three";

import type { Vec3 } from "./messages";
import { FORCE_COLOR, TARGET_COLOR } from "./theme";

const METRES_PER_NEWTON = 0.01;
const SMALLEST_FORCE = 0.5; // N; below it no arrow
const HEAD_LENGTH = 0.09; // m

const UP = new Vector3(0, 1, 0); // axis of three's cylinders and cones

function glowing(color: number): MeshStandardMaterial {
  const material = new MeshStandardMaterial({ color, emissive: color, emissiveIntensity: 0.45 });
  material.depthTest = false; // the hand is often inside the device's last link
  material.transparent = true; // drawn after the solid parts
  return material;
}

export class HandleView {
  readonly group = new Group();
  private readonly arrow = new Group();
  private readonly shaft: Mesh;
  private readonly head: Mesh;
  private readonly band: Mesh;
  private readonly target: Mesh;

  constructor() {
    const force = glowing(FORCE_COLOR);
    const pull = glowing(TARGET_COLOR);
    this.shaft = new Mesh(new CylinderGeometry(0.014, 0.014, 1, 20), force);
    this.head = new Mesh(new ConeGeometry(0.038, HEAD_LENGTH, 24), force);
    this.band = new Mesh(new CylinderGeometry(0.005, 0.005, 1, 12), pull);
    this.target = new Mesh(new SphereGeometry(0.03, 24, 16), pull);
    this.arrow.add(this.shaft, this.head);
    this.group.add(this.band, this.target, this.arrow);
    this.group.children.forEach((part, order) => {
      part.traverse((piece) => (piece.renderOrder = 10 + order));
    });
  }

  show_force(p_B: Vec3, force_N: Vec3): void {
    const force = new Vector3(...force_N);
    const length = METRES_PER_NEWTON * force.length();
    this.arrow.visible = force.length() > SMALLEST_FORCE;
    if (!this.arrow.visible) return;
    this.arrow.position.set(...p_B);
    this.arrow.quaternion.setFromUnitVectors(UP, force.normalize());
    const size = Math.min(1, length / (1.5 * HEAD_LENGTH)); // small forces get a small arrow
    const shaft_length = length - size * HEAD_LENGTH;
    this.shaft.scale.set(size, shaft_length, size);
    this.shaft.position.y = 0.5 * shaft_length;
    this.head.scale.setScalar(size);
    this.head.position.y = shaft_length + 0.5 * size * HEAD_LENGTH;
  }

  show_target(p_B: Vec3, target: Vec3 | null): void {
    this.band.visible = this.target.visible = target !== null;
    if (target === null) return;
    const from = new Vector3(...p_B);
    const to = new Vector3(...target);
    this.target.position.copy(to);
    const length = from.distanceTo(to);
    this.band.position.addVectors(from, to).multiplyScalar(0.5);
    this.band.scale.y = Math.max(0.001, length);
    if (length > 1e-4) this.band.quaternion.setFromUnitVectors(UP, to.sub(from).normalize());
  }
}
