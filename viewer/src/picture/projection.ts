// A flat view: which way it looks, and where points of B lie in it. Pure functions.

import type { Vec3 } from "../messages";
import type { Point } from "./outline";

export interface Facing {
  name: string;
  right: Vec3; // axes of the picture, in B
  up: Vec3;
  into: Vec3;
}

export const SIDE: Facing = { name: "From the side", right: [1, 0, 0], up: [0, 0, 1], into: [0, 1, 0] };
export const TOP: Facing = { name: "From above", right: [1, 0, 0], up: [0, 1, 0], into: [0, 0, -1] };

export interface Area {
  low: Point; // m, along right and up
  high: Point;
}

export interface Projection {
  facing: Facing;
  scale: number; // CSS pixels per m
  origin: Point; // of B, CSS pixels
}

export function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The largest picture of `area` in `width` x `height`, in the middle.
export function fitted(facing: Facing, area: Area, width: number, height: number): Projection {
  const size = [area.high[0] - area.low[0], area.high[1] - area.low[1]] as const;
  const scale = Math.max(1, Math.min(width / size[0], height / size[1]));
  const middle = [0.5 * (area.low[0] + area.high[0]), 0.5 * (area.low[1] + area.high[1])] as const;
  return {
    facing,
    scale,
    origin: [0.5 * width - middle[0] * scale, 0.5 * height + middle[1] * scale],
  };
}

export function projected({ facing, scale, origin }: Projection, p_B: Vec3): Point {
  return [origin[0] + scale * dot(p_B, facing.right), origin[1] - scale * dot(p_B, facing.up)];
}

// A point of B that lies at `pixel`, far in front of everything.
export function unprojected({ facing, scale, origin }: Projection, pixel: Point): Vec3 {
  const FAR = 100; // m
  const [right, up] = [(pixel[0] - origin[0]) / scale, (origin[1] - pixel[1]) / scale];
  const along = (i: 0 | 1 | 2): number =>
    right * facing.right[i] + up * facing.up[i] - FAR * facing.into[i];
  return [along(0), along(1), along(2)];
}

// The smallest area with `air` around all points.
export function area_of(facing: Facing, points: readonly Vec3[], air: number): Area {
  const [rights, ups] = [points.map((p) => dot(p, facing.right)), points.map((p) => dot(p, facing.up))];
  return {
    low: [Math.min(...rights) - air, Math.min(...ups) - air],
    high: [Math.max(...rights) + air, Math.max(...ups) + air],
  };
}
