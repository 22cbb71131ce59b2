// Where a pointer ray puts the dragged target. Pure functions; B is the base frame, z up.

import type { Vec3 } from "../messages";

export interface Ray {
  origin: Vec3;
  direction: Vec3; // unit length
}

// below this elevation of the view a level plane is seen too much from its edge
const SMALLEST_ELEVATION = Math.sin((12 * Math.PI) / 180);

export function add(a: Vec3, b: Vec3): Vec3 {
  return [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
}

export function subtract(a: Vec3, b: Vec3): Vec3 {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

export function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

export function norm(a: Vec3): number {
  return Math.hypot(...a);
}

// Normal of the plane in which the target moves: level, or facing the camera when the camera looks
// almost level itself.
export function drag_normal(view_direction: Vec3): Vec3 {
  return Math.abs(view_direction[2]) >= SMALLEST_ELEVATION ? [0, 0, 1] : view_direction;
}

// Where the ray meets the plane through `point`; null when it runs along it or away from it.
export function meet_plane(ray: Ray, point: Vec3, normal: Vec3): Vec3 | null {
  const approach = dot(ray.direction, normal);
  if (Math.abs(approach) < 1e-6) return null;
  const distance = dot(subtract(point, ray.origin), normal) / approach;
  if (distance <= 0) return null;
  return along(ray, distance);
}

// The point of the line through `point` along the unit vector `axis` that is nearest to the ray;
// null when the ray runs along it.
export function meet_axis(ray: Ray, point: Vec3, axis: Vec3): Vec3 | null {
  const cosine = dot(ray.direction, axis);
  const apart = 1 - cosine * cosine;
  if (apart < 0.0025) return null;
  const away = subtract(ray.origin, point);
  const distance = (dot(away, axis) - cosine * dot(away, ray.direction)) / apart;
  return add(point, [axis[0] * distance, axis[1] * distance, axis[2] * distance]);
}

// `target` moved towards `center` until it is at most `reach` away.
export function within_reach(target: Vec3, center: Vec3, reach: number): Vec3 {
  const away = subtract(target, center);
  const share = Math.min(1, reach / Math.max(norm(away), 1e-9));
  return add(center, [away[0] * share, away[1] * share, away[2] * share]);
}

function along(ray: Ray, distance: number): Vec3 {
  const [x, y, z] = ray.direction;
  return add(ray.origin, [x * distance, y * distance, z * distance]);
}
