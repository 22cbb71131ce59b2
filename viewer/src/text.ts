// Numbers and states in words. Pure functions.

import type { Frame, SceneJoint, SceneLimit } from "./messages";

export function time_text(time_s: number): string {
  const minutes = Math.floor(time_s / 60);
  const seconds = (time_s - 60 * minutes).toFixed(1).padStart(4, "0");
  return `${minutes}:${seconds}`;
}

export function joint_text(value: number, joint: Pick<SceneJoint, "type">): string {
  if (!Number.isFinite(value)) return "-";
  return joint.type === "prismatic"
    ? `${(100 * value).toFixed(1)} cm`
    : `${((value * 180) / Math.PI).toFixed(1)}\u00b0`;
}

// Share of the way between the ends of a limit, 0..1; null when it has no two ends.
export function share_of_range(value: number, limit: SceneLimit | undefined): number | null {
  if (!limit || limit.min === null || limit.max === null || limit.max <= limit.min) return null;
  return Math.min(1, Math.max(0, (value - limit.min) / (limit.max - limit.min)));
}

export function force_of(frame: Frame): number {
  const force = Math.hypot(...frame.force_N);
  return Number.isFinite(force) ? force : 0;
}

export function felt_text(frame: Frame): string {
  if (frame.felt) return frame.felt.text;
  return force_of(frame) < 1 ? "nothing holds you" : "the twin's mass, friction, springs";
}

// False while a number is missing: it was not finite in the program.
export function is_complete(frame: Frame): boolean {
  return [...frame.q_device, ...frame.q_twin, ...frame.p_B_H_m].every(Number.isFinite);
}

export function hint_text(has_lever: boolean, is_touch: boolean): string {
  const grab = has_lever ? "Drag the ringed handle to push the door" : "Drag the ringed handle";
  const lift = is_touch ? "up / down lifts it" : "with Shift it goes up and down";
  const press = is_touch ? "press pushes the lever down" : "Space presses the lever";
  return `${grab}; ${lift}${has_lever ? `; ${press}` : ""}. Drag elsewhere to look around.`;
}
