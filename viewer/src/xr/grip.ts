// Geometry of the headset. Pure functions.

import { Matrix4, Quaternion, Vector3 } from "three";

import type { Quaternion as Turn, Vec3 } from "../messages";

const STAND_BACK = 0.55; // m, from the handle

interface Held {
  from: Vector3;
  attitude: Quaternion;
  handle: Vector3;
  handle_attitude: Quaternion;
}

// Where the handle goes when the controller that took hold of it is at `now` with `attitude`.
export function grip_target(
  held: Held,
  now: Vector3,
  attitude: Quaternion,
): { p_B: Vec3; turn: Turn } {
  const p = held.handle.clone().add(now).sub(held.from);
  const turn = attitude.clone().multiply(held.attitude.clone().invert());
  const { x, y, z, w } = turn.multiply(held.handle_attitude).normalize();
  return { p_B: [p.x, p.y, p.z], turn: [x, y, z, w] };
}

// Where the headset's space (y up, -z ahead) lies in B so that its wearer stands before the handle.
export function placed_rig(
  handle: Vector3,
  to_user: Vector3,
  floor_z: number,
): { position: Vector3; quaternion: Quaternion } {
  const back = new Vector3(to_user.x, to_user.y, 0);
  if (back.length() < 0.1) back.set(0, -1, 0);
  back.normalize();
  const up = new Vector3(0, 0, 1);
  const basis = new Matrix4().makeBasis(new Vector3().crossVectors(up, back), up, back);
  const position = handle.clone().addScaledVector(back, STAND_BACK).setZ(floor_z);
  return { position, quaternion: new Quaternion().setFromRotationMatrix(basis) };
}

// The same with the handle above `on_floor`, a place of the headset's space, which is turned so that
// a wearer whose head is at `head` stands before it.
export function placed_at(
  on_floor: Vector3,
  head: Vector3,
  handle: Vector3,
  to_user: Vector3,
  floor_z: number,
): { position: Vector3; quaternion: Quaternion } {
  const { quaternion } = placed_rig(handle, to_user, floor_z);
  const azimuth = Math.atan2(head.x - on_floor.x, head.z - on_floor.z);
  quaternion.multiply(new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), -azimuth));
  const offset = on_floor.clone().setY(0).applyQuaternion(quaternion);
  return { position: handle.clone().setZ(floor_z).sub(offset), quaternion };
}
