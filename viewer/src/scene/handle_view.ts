// What happens at the handle: the user's force and torque as arrows, the rubber band to the dragged
// target.

import { Group, Mesh, SphereGeometry, Vector3 } from "three";

import type { Vec3 } from "../messages";
import { FORCE_COLOR, TARGET_COLOR, TORQUE_COLOR } from "../theme";
import type { ArrowSize } from "./arrow_size";
import { Bar, ForceArrow, TorqueArrow } from "./arrows";
import { glowing } from "./materials";

const METRES_PER_NEWTON = 0.01;
const SMALLEST_FORCE = 0.5; // N; below it no arrow
const RADIANS_PER_NEWTON_METRE = 0.8;
const RAIL_REACH = 1.5; // m
const SMALLEST_TORQUE = 0.15; // Nm

export class HandleView {
  readonly arrows = new Group();
  readonly pull = new Group();
  private readonly force = new ForceArrow(glowing(FORCE_COLOR));
  private readonly torque = new TorqueArrow(glowing(TORQUE_COLOR));
  private readonly band: Bar;
  private readonly rail: Bar;
  private readonly target: Mesh;

  constructor(private readonly size: ArrowSize) {
    const material = glowing(TARGET_COLOR);
    this.band = new Bar(0.005, material);
    this.rail = new Bar(0.002, material);
    this.target = new Mesh(new SphereGeometry(0.03, 24, 16), material);
    for (const { group } of [this.torque, this.force]) group.scale.setScalar(size.share);
    this.arrows.add(this.torque.group, this.force.group);
    this.pull.add(this.band.mesh, this.rail.mesh, this.target);
    for (const [order, parts] of [this.pull, this.arrows].entries()) {
      parts.traverse((part) => (part.renderOrder = 10 + order));
    }
  }

  show_wrench(p_B: Vec3, force_N: Vec3, torque_Nm: Vec3): void {
    const { share, longest_m } = this.size; // lengths of a group are multiplied by its scale
    const scale = METRES_PER_NEWTON / share;
    this.force.show(p_B, force_N, scale, SMALLEST_FORCE, longest_m / share);
    this.torque.show(p_B, torque_Nm, RADIANS_PER_NEWTON_METRE, SMALLEST_TORQUE);
  }

  // `axis`: the only direction in which the target moves, null = any.
  show_target(p_B: Vec3, target: Vec3 | null, axis: Vec3 | null): void {
    this.pull.visible = target !== null;
    if (target === null) return;
    this.target.position.set(...target);
    this.band.span(new Vector3(...p_B), this.target.position);
    this.rail.mesh.visible = axis !== null;
    if (axis === null) return;
    const reach = new Vector3(...axis).multiplyScalar(RAIL_REACH);
    const [from, to] = [
      this.target.position.clone().sub(reach),
      this.target.position.clone().add(reach),
    ];
    this.rail.span(from, to);
  }
}
