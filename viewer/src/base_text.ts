// The motion of the place where a twin stands, in words. Pure functions.

import { Quaternion, Vector3 } from "three";

import type { Scene, TwinBase } from "./messages";

interface Away {
  way_m: Vector3; // from where it rests
  turn_rad: number;
}

export function away_from_rest({ twin }: Scene, { p_B_m, quaternion_B }: TwinBase): Away {
  const turn = new Quaternion(...quaternion_B).angleTo(new Quaternion(...twin.quaternion_B_root));
  return { way_m: new Vector3(...p_B_m).sub(new Vector3(...twin.p_B_root_m)), turn_rad: turn };
}

// Empty: it rests, and always does.
export function base_text(scene: Scene, base: TwinBase | null): string {
  if (!scene.twin_base_moves || !base) return "";
  const { way_m, turn_rad } = away_from_rest(scene, base);
  const [way, turn] = [1000 * way_m.length(), (180 / Math.PI) * turn_rad];
  const speed = Math.hypot(...base.v_m_per_s);
  const where = `${way.toFixed(0)} mm and ${turn.toFixed(1)}\u00b0 from where it rests, at ${(100 * speed).toFixed(0)} cm/s`;
  return `What carries the twin moves (${where}). You feel that as mass of the twin.`;
}
