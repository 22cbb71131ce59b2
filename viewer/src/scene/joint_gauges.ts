// Rings at the joints of the device: the range with its ends, where the joint is, and the measured
// torque as an arc whose length is the share of the joint's largest torque.

import {
  DoubleSide,
  Group,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  type Object3D,
  PlaneGeometry,
  RingGeometry,
  Vector3,
} from "three";
import type { URDFJoint } from "urdf-loader";

import type { Closeness } from "../limit_words";
import { ACTIVE_COLOR, GOOD_COLOR, NEAR_COLOR, TORQUE_COLOR } from "../theme";

const FREE_COLOR = 0x7f95ab;
const COLORS: Record<Closeness, number> = {
  far: GOOD_COLOR,
  near: NEAR_COLOR,
  active: ACTIVE_COLOR,
};
const STEPS = 96; // of a full ring
const WIDTH = 0.016; // m
const TORQUE_ARC = 1.5 * Math.PI; // at the largest torque
const STRONGEST_JOINT = 176; // Nm; its gauge is the largest

export class JointGauge {
  readonly limit_ring = new Group();
  readonly torque_ring = new Group();
  private readonly range_material: MeshBasicMaterial;
  private readonly needle: Group = new Group();
  private readonly torque: Mesh<RingGeometry, MeshBasicMaterial>;
  private readonly effort: number; // Nm
  private readonly is_limited: boolean;

  // `range` = null: turns without end; `torque_max` = null: unknown.
  constructor(
    joint: URDFJoint,
    range: { min: number; max: number } | null,
    torque_max: number | null,
  ) {
    this.effort = torque_max ?? STRONGEST_JOINT;
    const radius = 0.06 + 0.075 * Math.sqrt(Math.min(1, this.effort / STRONGEST_JOINT));
    this.is_limited = range !== null;
    this.range_material = flat(range ? GOOD_COLOR : FREE_COLOR, 0.75);
    const [start, turn] = range ? [range.min, range.max - range.min] : [0, 2 * Math.PI];
    const is_full = turn >= 2 * Math.PI - 1e-3;
    const steps = Math.max(2, Math.round((Math.min(turn, 2 * Math.PI) / (2 * Math.PI)) * STEPS));
    const arc = new RingGeometry(
      radius,
      radius + WIDTH,
      steps,
      1,
      start,
      Math.min(turn, 2 * Math.PI),
    );
    this.limit_ring.add(new Mesh(arc, this.range_material));
    if (!is_full) this.add_ends(radius, start, start + turn);
    this.add_needle(radius);
    const shape = new RingGeometry(radius + 1.6 * WIDTH, radius + 3.2 * WIDTH, STEPS);
    this.torque = new Mesh(shape, flat(TORQUE_COLOR, 0.9));
    this.torque_ring.add(this.torque);
    stand_at(joint, [this.limit_ring, this.torque_ring]);
  }

  show(q: number, closeness: Closeness): void {
    this.needle.rotation.z = q;
    this.range_material.color.set(this.is_limited ? COLORS[closeness] : FREE_COLOR);
    this.range_material.opacity = closeness === "far" ? 0.6 : 1;
  }

  show_torque(q: number, torque_Nm: number): void {
    const share = Math.min(1, Math.abs(torque_Nm) / this.effort);
    const steps = Math.round(((share * TORQUE_ARC) / (2 * Math.PI)) * STEPS);
    this.torque.geometry.setDrawRange(0, 6 * steps);
    this.torque.rotation.z = q;
    this.torque.scale.y = torque_Nm < 0 ? -1 : 1;
    this.torque.material.color.set(share > 0.9 ? ACTIVE_COLOR : TORQUE_COLOR);
  }

  private add_ends(radius: number, low: number, high: number): void {
    for (const angle of [low, high]) {
      const end = new Mesh(new PlaneGeometry(3 * WIDTH, 0.4 * WIDTH), this.range_material);
      end.position.set(Math.cos(angle), Math.sin(angle), 0).multiplyScalar(radius + 0.5 * WIDTH);
      end.rotation.z = angle;
      this.limit_ring.add(end);
    }
  }

  private add_needle(radius: number): void {
    const pointer = new Mesh(new PlaneGeometry(4 * WIDTH, 0.5 * WIDTH), flat(0x1f2933, 0.95));
    pointer.position.set(radius + 0.2 * WIDTH, 0, 0.0015);
    const back = pointer.clone();
    back.position.z = -0.0015;
    this.needle.add(pointer, back);
    this.limit_ring.add(this.needle);
  }
}

// The parts stand still with the parent link: z = axis, x = where the child points at zero.
export function stand_at(joint: URDFJoint, parts: Object3D[]): void {
  const axis = joint.axis.clone().normalize();
  const towards = child_direction(joint, axis);
  const basis = new Matrix4().makeBasis(towards, new Vector3().crossVectors(axis, towards), axis);
  for (const part of parts) {
    const mount = new Group();
    mount.position.copy(joint.position);
    mount.quaternion.copy(joint.quaternion);
    part.quaternion.setFromRotationMatrix(basis);
    mount.add(part);
    joint.parent!.add(mount);
  }
}

function flat(color: number, opacity: number): MeshBasicMaterial {
  return new MeshBasicMaterial({
    color,
    opacity,
    transparent: true,
    side: DoubleSide,
    toneMapped: false,
  });
}

// Where the next joint is, seen along the axis, in the joint's frame at zero.
function child_direction(joint: URDFJoint, axis: Vector3): Vector3 {
  let found: Vector3 | null = null;
  joint.traverse((part) => {
    if (found || part === joint || !("isURDFJoint" in part)) return;
    found = part.position.clone();
  });
  const towards = found ?? new Vector3(1, 0, 0);
  (towards as Vector3).addScaledVector(axis, -(towards as Vector3).dot(axis));
  if ((towards as Vector3).length() > 0.02) return (towards as Vector3).normalize();
  const other = Math.abs(axis.x) < 0.9 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
  return other.addScaledVector(axis, -other.dot(axis)).normalize();
}
