// Limits in words and how close they are. Pure functions.

import type { ActiveLimit, Frame, Scene, SceneLimit } from "./messages";

export type Closeness = "far" | "near" | "active";

const NEAR_RAD = (8 * Math.PI) / 180;
const NEAR_M = 0.08;

export function is_near(distance: number | null | undefined, unit: SceneLimit["unit"]): boolean {
  if (distance === null || distance === undefined) return false;
  return distance < (unit === "rad" ? NEAR_RAD : NEAR_M);
}

export function limit_closeness(scene: Scene, frame: Frame, index: number): Closeness {
  const active = frame.active.find((limit) => limit.index === index);
  if (active && active.state !== "inactive") return "active";
  return is_near(frame.limit_distance[index], scene.limits[index]!.unit) ? "near" : "far";
}

const KINDS: Record<SceneLimit["kind"], string> = {
  manipulator: "joint of the device",
  virtual: "keeps away from the singularity",
  cartesian: "wall of the workspace",
  motor: "motor of the device",
  twin: "joint of the twin",
  self_collision: "the device would hit itself or the floor",
};

const CAUSES: Record<ActiveLimit["cause"], string> = {
  none: "",
  position: "end of its range",
  velocity: "cannot move faster",
  acceleration: "cannot speed up or brake harder",
  lock: "locked",
  latch: "latched: closes, does not open",
  friction: "held by friction",
  contradiction: "held between limits that contradict each other",
  torque: "has no more torque",
  torque_rate: "its torque is building up",
  weight: "carries its share of the arm's weight",
  braking: "slower here, at this speed it could not stop before its end",
};

// "end of its range, joint of the device"
export function reason_text(limit: SceneLimit, active: ActiveLimit): string {
  return [CAUSES[active.cause], KINDS[limit.kind]].filter((text) => text !== "").join(" \u00b7 ");
}

export function kind_text(kind: SceneLimit["kind"]): string {
  return KINDS[kind];
}

export function distance_text(distance: number, unit: SceneLimit["unit"]): string {
  if (unit === "m") return `${unsigned_zero((100 * distance).toFixed(distance < 0.1 ? 1 : 0))} cm`;
  return `${unsigned_zero(((180 * distance) / Math.PI).toFixed(1))}\u00b0`;
}

function unsigned_zero(number: string): string {
  return Number(number) === 0 ? number.replace("-", "") : number;
}

export function reaction_text(reaction: number, unit: SceneLimit["unit"]): string {
  const size = Math.abs(reaction);
  return `${size.toFixed(size < 10 ? 1 : 0)} ${unit === "rad" ? "Nm" : "N"}`;
}

interface NearLimit {
  index: number;
  distance: number;
}

// Limits that do not act, the nearest in terms of "near" first.
export function nearest_limits(scene: Scene, frame: Frame, most: number): NearLimit[] {
  const acting = new Set(frame.active.map((limit) => limit.index));
  const share = ({ index, distance }: NearLimit): number =>
    distance / (scene.limits[index]!.unit === "rad" ? NEAR_RAD : NEAR_M);
  return frame.limit_distance
    .map((distance, index) => ({ index, distance: distance ?? Infinity }))
    .filter(({ index, distance }) => Number.isFinite(distance) && !acting.has(index))
    .sort((a, b) => share(a) - share(b))
    .slice(0, most);
}
