// A plain body for chains whose URDF has no shapes, or only mesh files that were not found:
// bars from joint to joint.

import {
  type Object3D,
  CylinderGeometry,
  Mesh,
  MeshStandardMaterial,
  SphereGeometry,
  Vector3,
} from "three";
import type { URDFRobot } from "urdf-loader";

const BAR_RADIUS = 0.03; // m
const JOINT_RADIUS = 0.045; // m

export function has_shapes(robot: URDFRobot | null): boolean {
  let found = false;
  robot?.traverse((part) => (found ||= part instanceof Mesh));
  return found;
}

export function add_skeleton(robot: URDFRobot, color: number): void {
  const material = new MeshStandardMaterial({ color, roughness: 0.6 });
  const ball = new SphereGeometry(JOINT_RADIUS, 24, 16);
  for (const joint of Object.values(robot.joints)) {
    const link = joint.parent;
    if (link) add_bar(link, joint.position, material);
    joint.add(new Mesh(ball, material));
  }
}

function add_bar(link: Object3D, end: Vector3, material: MeshStandardMaterial): void {
  const length = end.length();
  if (length < 0.01) return;
  const bar = new Mesh(new CylinderGeometry(BAR_RADIUS, BAR_RADIUS, length, 20), material);
  bar.position.copy(end).multiplyScalar(0.5);
  bar.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), end.clone().normalize());
  link.add(bar);
}
