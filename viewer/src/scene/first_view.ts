// The first view of an arm shows all of it, the mechanism, and the person who holds it.

import { MathUtils, type PerspectiveCamera, Sphere, Vector3 } from "three";

import type { Frame, Scene } from "../messages";
import { STAND_BACK, STAND_LEFT } from "./stance";

const HEAD = 1.8; // m above the floor
const LOOKING_DOWN = 0.3; // slope

export interface Sight {
  from: Vector3;
  at: Vector3;
}

// Where an arm without a gantry stands; null: the device hangs above the person.
export function foot_of_arm(scene: Scene): Vector3 | null {
  return scene.gantry_joints === 0 ? new Vector3(...scene.device.p_B_root_m) : null;
}

// Places that must be seen; the handle is the first, the foot of the arm the second.
export function what_matters(scene: Scene, frame: Frame, foot: Vector3): Vector3[] {
  const handle = new Vector3(...frame.p_B_H_m);
  const away = handle.clone().sub(foot).setZ(0).normalize();
  const left = new Vector3(away.y, -away.x, 0); // of the person, who faces the arm
  const person = handle.clone().addScaledVector(away, STAND_BACK).addScaledVector(left, STAND_LEFT);
  return [
    handle,
    foot,
    foot.clone().setZ(scene.floor_z_m),
    new Vector3(...scene.twin.p_B_root_m),
    person.clone().setZ(scene.floor_z_m),
    person.clone().setZ(scene.floor_z_m + HEAD),
  ];
}

// A view from the side, between arm and person, from where y is small as that of other devices.
export function sight_of(places: Vector3[], camera: PerspectiveCamera): Sight {
  const [handle, foot] = places as [Vector3, Vector3];
  const all = new Sphere().setFromPoints(places);
  const along = handle.clone().sub(foot);
  const side = new Vector3(along.y, -along.x, 0).normalize();
  if (side.y > 0) side.negate();
  const half = Math.tan(0.5 * MathUtils.degToRad(camera.fov)) * Math.min(1, camera.aspect);
  const away = all.radius / Math.sin(Math.atan(half));
  const from = all.center.clone().addScaledVector(side.setZ(LOOKING_DOWN).normalize(), away);
  return { from, at: all.center };
}
