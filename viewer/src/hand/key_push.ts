// Keys that push the hand: the longer a key is held, the harder, up to a largest force; a released
// key pushes no more, at once. Pure functions of which keys are held since when.

import type { Vec3 } from "../messages";

export const LARGEST_N = 30;
export const RISE_N_PER_S = 30;

// A key by its place on the keyboard: away from the viewer, to the right, up.
const DIRECTIONS: Record<string, Vec3> = {
  KeyW: [1, 0, 0],
  ArrowUp: [1, 0, 0],
  KeyS: [-1, 0, 0],
  ArrowDown: [-1, 0, 0],
  KeyD: [0, 1, 0],
  ArrowRight: [0, 1, 0],
  KeyA: [0, -1, 0],
  ArrowLeft: [0, -1, 0],
  KeyE: [0, 0, 1],
  KeyQ: [0, 0, -1],
};

export function is_push_key(code: string): boolean {
  return Object.hasOwn(DIRECTIONS, code);
}

// N, away from the viewer, to the right, up; `held`: keys and the time since when, ms.
export function push_of(held: ReadonlyMap<string, number>, now_ms: number): Vec3 {
  const sum: Vec3 = [0, 0, 0];
  for (const [code, since_ms] of held) {
    const force = Math.min(LARGEST_N, RISE_N_PER_S * 0.001 * Math.max(0, now_ms - since_ms));
    DIRECTIONS[code]!.forEach((share, i) => (sum[i]! += share * force));
  }
  const scale = Math.min(1, LARGEST_N / Math.max(Math.hypot(...sum), 1e-9));
  return [sum[0] * scale, sum[1] * scale, sum[2] * scale];
}

// The same in B, for a viewer who looks along `direction`.
export function in_base([away, right, up]: Vec3, direction: Vec3): Vec3 {
  const level = Math.hypot(direction[0], direction[1]);
  const [x, y] = level > 1e-3 ? [direction[0] / level, direction[1] / level] : [0, 1];
  return [away * x + right * y, away * y - right * x, up];
}

// Where the hand has to be pulled to from the handle for this force: its arm is a spring.
export function offset_of(force_N: Vec3, stiffness_N_per_m: Vec3, force_max_N: number): Vec3 {
  const scale = Math.min(1, force_max_N / Math.max(Math.hypot(...force_N), 1e-9));
  const along = (i: 0 | 1 | 2): number =>
    stiffness_N_per_m[i] > 0 ? (scale * force_N[i]) / stiffness_N_per_m[i] : 0;
  return [along(0), along(1), along(2)];
}
