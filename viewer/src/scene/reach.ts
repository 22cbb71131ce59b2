// Where the elbow of an arm is. Pure geometry.

import { Vector3 } from "three";

// Elbow of an arm with the given lengths that bends `towards` a point. Beyond their reach both
// parts stretch alike.
export function elbow_between(
  shoulder: Vector3,
  wrist: Vector3,
  upper: number,
  lower: number,
  towards: Vector3,
): Vector3 {
  const along = new Vector3().subVectors(wrist, shoulder);
  const distance = along.length();
  if (distance >= upper + lower || distance < 1e-6) {
    return shoulder.clone().addScaledVector(along, upper / (upper + lower));
  }
  along.divideScalar(distance);
  const share = (upper * upper - lower * lower + distance * distance) / (2 * distance);
  const out = Math.sqrt(Math.max(0, upper * upper - share * share));
  const side = new Vector3().subVectors(towards, shoulder);
  side.addScaledVector(along, -side.dot(along)).normalize();
  return shoulder.clone().addScaledVector(along, share).addScaledVector(side, out);
}
