// Outlines of bodies for flat pictures: a body is drawn as the convex hull of its points.

import { type BufferGeometry, Vector3 } from "three";

export type Point = readonly [number, number];

const DIRECTIONS = spread(48);
const known = new WeakMap<BufferGeometry, Vector3[]>();

// Points of a shape that stand out furthest, few enough to be projected for every picture.
export function outer_points(shape: BufferGeometry): Vector3[] {
  const found = known.get(shape);
  if (found) return found;
  const places = shape.getAttribute("position");
  const outer = new Set<number>();
  const point = new Vector3();
  for (const direction of DIRECTIONS) {
    let [best, furthest] = [-1, -Infinity];
    for (let i = 0; i < places.count; i++) {
      const reach = point.fromBufferAttribute(places, i).dot(direction);
      if (reach > furthest) [best, furthest] = [i, reach];
    }
    if (best >= 0) outer.add(best);
  }
  const points = [...outer].map((i) => new Vector3().fromBufferAttribute(places, i));
  known.set(shape, points);
  return points;
}

// Corners of the convex hull, counterclockwise where y points up (monotone chain, A. M. Andrew
// 1979).
export function hull_of(points: readonly Point[]): Point[] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  if (sorted.length < 3) return sorted;
  const half = (all: readonly Point[]): Point[] => {
    const chain: Point[] = [];
    for (const point of all) {
      while (chain.length >= 2 && turn(chain.at(-2)!, chain.at(-1)!, point) <= 0) chain.pop();
      chain.push(point);
    }
    return chain.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

function turn(a: Point, b: Point, c: Point): number {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Directions that are spread evenly: a spiral from pole to pole.
function spread(count: number): Vector3[] {
  const golden = Math.PI * (3 - Math.sqrt(5));
  return Array.from({ length: count }, (_, i) => {
    const z = 1 - (2 * i + 1) / count;
    const radius = Math.sqrt(1 - z * z);
    return new Vector3(radius * Math.cos(golden * i), radius * Math.sin(golden * i), z);
  }).concat([1, -1].flatMap((s) => [new Vector3(s, 0, 0), new Vector3(0, s, 0), new Vector3(0, 0, s)]));
}
