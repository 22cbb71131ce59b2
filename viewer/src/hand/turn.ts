// How the pointer turns the handle. Pure functions.

import { Quaternion, Vector3 } from "three";

import type { Quaternion as Turn, Vec3 } from "../messages";

const RADIANS_PER_PIXEL = 0.008;

// `start`, turned by a move of the pointer: right turns about the vertical, down about the axis
// that points to the right of the view.
export function turned(start: Turn, right_px: number, down_px: number, view: Vec3): Turn {
  const right = new Vector3(view[1], -view[0], 0);
  if (right.length() < 1e-6) right.set(1, 0, 0);
  const about_up = new Quaternion().setFromAxisAngle(
    new Vector3(0, 0, 1),
    RADIANS_PER_PIXEL * right_px,
  );
  const about_right = new Quaternion().setFromAxisAngle(
    right.normalize(),
    RADIANS_PER_PIXEL * down_px,
  );
  const result = about_up
    .multiply(about_right)
    .multiply(new Quaternion(...start))
    .normalize();
  return [result.x, result.y, result.z, result.w];
}
