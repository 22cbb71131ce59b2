// How large arrows are drawn for a device: as on a HapticGiant, they are not to hide its links.

import { MathUtils, type Object3D, Vector3 } from "three";

export interface ArrowSize {
  share: number; // of the full thickness
  longest_m: number;
}

const FULL_LENGTH = 2.37; // m, of the links of a HapticGiant between its first and its last joint
const LONGEST = 0.35; // share of the links
const THINNEST = 0.5; // still seen beside a hand

// For a device with these joints, in their order; they need not be posed.
export function arrow_size(joints: Object3D[]): ArrowSize {
  const places = joints.map((joint) => joint.getWorldPosition(new Vector3()));
  const links = places.slice(1).map((place, i) => place.distanceTo(places[i]!));
  const known = links.reduce((sum, length) => sum + length, 0);
  const length = known > 0 ? known : FULL_LENGTH;
  const share = MathUtils.clamp(length / FULL_LENGTH, THINNEST, 1);
  return { share, longest_m: LONGEST * length };
}
