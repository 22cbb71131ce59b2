// Arrows for forces and torques, and a bar between two points.

import {
  ConeGeometry,
  CylinderGeometry,
  Group,
  Mesh,
  type MeshStandardMaterial,
  TorusGeometry,
  Vector3,
} from "three";

import type { Vec3 } from "../messages";

const HEAD_LENGTH = 0.09; // m
const UP = new Vector3(0, 1, 0); // axis of three's cylinders and cones
const FORWARD = new Vector3(0, 0, 1); // axis of three's tori
const MOST_TURN = 1.7 * Math.PI; // of a torque's arc
const ARC_STEPS = 64;
const ARC_RADIUS = 0.13; // m
const ARC_SIDES = 10;

// A straight arrow that starts at a point.
export class ForceArrow {
  readonly group = new Group();
  private readonly shaft: Mesh;
  private readonly head: Mesh;

  constructor(material: MeshStandardMaterial) {
    this.shaft = new Mesh(new CylinderGeometry(0.013, 0.013, 1, 20), material);
    this.head = new Mesh(new ConeGeometry(0.036, HEAD_LENGTH, 24), material);
    this.group.add(this.shaft, this.head);
  }

  // Shows `value` with `metres_per_unit`; nothing below `smallest`, and no longer than `longest` (m).
  show(p_B: Vec3, value: Vec3, metres_per_unit: number, smallest: number, longest: number): void {
    const vector = new Vector3(...value);
    const length = Math.min(longest, metres_per_unit * vector.length());
    this.group.visible = vector.length() > smallest;
    if (!this.group.visible) return;
    this.group.position.set(...p_B);
    this.group.quaternion.setFromUnitVectors(UP, vector.normalize());
    const size = Math.min(1, length / (1.5 * HEAD_LENGTH)); // small forces get a small arrow
    const shaft_length = Math.max(0.001, length - size * HEAD_LENGTH);
    this.shaft.scale.set(size, shaft_length, size);
    this.shaft.position.y = 0.5 * shaft_length;
    this.head.scale.setScalar(size);
    this.head.position.y = shaft_length + 0.5 * size * HEAD_LENGTH;
  }
}

// An arc with a head, around the axis of a torque; its length is the torque.
export class TorqueArrow {
  readonly group = new Group();
  private readonly arc: Mesh<TorusGeometry>;
  private readonly head: Mesh;

  constructor(material: MeshStandardMaterial) {
    const shape = new TorusGeometry(ARC_RADIUS, 0.008, ARC_SIDES, ARC_STEPS, MOST_TURN);
    sort_by_angle(shape);
    this.arc = new Mesh(shape, material);
    this.head = new Mesh(new ConeGeometry(0.026, 0.06, 20), material);
    this.group.add(this.arc, this.head);
  }

  show(p_B: Vec3, value: Vec3, radians_per_unit: number, smallest: number): void {
    const vector = new Vector3(...value);
    const turn = Math.min(MOST_TURN, radians_per_unit * vector.length());
    this.group.visible = vector.length() > smallest;
    if (!this.group.visible) return;
    this.group.position.set(...p_B);
    this.group.quaternion.setFromUnitVectors(FORWARD, vector.normalize());
    const steps = Math.max(1, Math.round((turn / MOST_TURN) * ARC_STEPS));
    this.arc.geometry.setDrawRange(0, steps * ARC_SIDES * 6);
    const end = (steps / ARC_STEPS) * MOST_TURN;
    this.head.position.set(ARC_RADIUS * Math.cos(end), ARC_RADIUS * Math.sin(end), 0);
    this.head.rotation.z = end; // the cone's axis y points along the arc
  }
}

// three lists a torus ring by ring around the tube; here slice by slice along the arc.
function sort_by_angle(shape: TorusGeometry): void {
  const row = ARC_STEPS + 1;
  const order: number[] = [];
  for (let i = 1; i <= ARC_STEPS; i++) {
    for (let j = 1; j <= ARC_SIDES; j++) {
      const [a, b] = [row * j + i - 1, row * (j - 1) + i - 1];
      const [c, d] = [row * (j - 1) + i, row * j + i];
      order.push(a, b, d, b, c, d);
    }
  }
  shape.setIndex(order);
}

export class Bar {
  readonly mesh: Mesh;

  constructor(radius: number, material: MeshStandardMaterial) {
    this.mesh = new Mesh(new CylinderGeometry(radius, radius, 1, 12), material);
  }

  span(from: Vector3, to: Vector3): void {
    const length = from.distanceTo(to);
    this.mesh.position.addVectors(from, to).multiplyScalar(0.5);
    this.mesh.scale.y = Math.max(0.001, length);
    if (length > 1e-4) {
      this.mesh.quaternion.setFromUnitVectors(UP, new Vector3().subVectors(to, from).normalize());
    }
  }
}
