// Joints that follow others by a curve.

import type { SceneFollower } from "../messages";

// Position of such a joint where its leader is at q, between the values that are given.
export function position_of(follower: SceneFollower, q: number): number {
  const { begin, end, values } = follower;
  let share = (q - begin) / (end - begin);
  if (follower.is_periodic) share -= Math.floor(share);
  const place = Math.min(Math.max(share, 0), 1) * (values.length - 1);
  const before = Math.min(Math.floor(place), values.length - 2);
  const [a, b] = [values[before] ?? 0, values[before + 1] ?? 0];
  return a + (place - before) * (b - a);
}
