// The protective field of a laser scanner, for looks and planning: 270 degrees to 5 m, cut off at
// the hall. It stands at the foot of a column. [K] SICK TiM781S.

import { DoubleSide, Group, Mesh, MeshBasicMaterial, Shape, ShapeGeometry, Vector2 } from "three";

import type { SceneBox } from "../messages";
import { NEAR_COLOR } from "../theme";

const REACH = 5; // m
const OPENING = 1.5 * Math.PI;
const STEPS = 96;
const HEIGHT = 0.2; // m above the floor
const BEYOND = 0.6; // m, of the columns from the box

export function scanner_zone(box: SceneBox, floor_z_m: number): Group {
  const low = new Vector2(box.min_m[0] - BEYOND, box.min_m[1] - BEYOND);
  const high = new Vector2(box.max_m[0] + BEYOND, box.max_m[1] + BEYOND);
  const outline = new Shape(field(new Vector2(high.x, high.y), low, high));
  const material = new MeshBasicMaterial({
    color: NEAR_COLOR,
    opacity: 0.16,
    transparent: true,
    side: DoubleSide,
    depthWrite: false,
  });
  const group = new Group();
  group.add(new Mesh(new ShapeGeometry(outline), material));
  group.position.z = floor_z_m + HEIGHT;
  group.visible = false;
  return group;
}

// Points of the field of a scanner at `from` that looks to the middle.
function field(from: Vector2, low: Vector2, high: Vector2): Vector2[] {
  const towards = new Vector2().addVectors(low, high).multiplyScalar(0.5).sub(from).angle();
  const points = [from.clone()];
  for (let i = 0; i <= STEPS; i++) {
    const angle = towards + OPENING * (i / STEPS - 0.5);
    const ray = new Vector2(Math.cos(angle), Math.sin(angle));
    const inside = Math.min(
      to_edge(from.x, ray.x, low.x, high.x),
      to_edge(from.y, ray.y, low.y, high.y),
    );
    points.push(from.clone().addScaledVector(ray, Math.min(REACH, inside)));
  }
  return points;
}

function to_edge(from: number, ray: number, low: number, high: number): number {
  if (Math.abs(ray) < 1e-9) return Infinity;
  return Math.max(0, ((ray > 0 ? high : low) - from) / ray);
}
