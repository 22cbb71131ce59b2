// What stands where, in cells of a few centimetres: whether one thing hides another is asked of
// these, because a mesh of a robot has too many triangles for thousands of rays. Pure geometry.

import { Box3, Mesh, type Object3D, Triangle, Vector3 } from "three";

const CELL = 0.03; // m
const SPACING = 0.8 * CELL; // of points on a surface
const STEP = 0.8 * CELL; // of a ray
const MOST_CELLS = 3e7; // beyond, cells are larger

// Points on all shapes under `root` that are shown, without those under `but`.
export function points_on(root: Object3D, but: Object3D | null = null): Vector3[] {
  root.updateWorldMatrix(true, true);
  const points: Vector3[] = [];
  const visit = (part: Object3D): void => {
    if (!part.visible || part === but) return;
    if (part instanceof Mesh) add_points(part, points);
    part.children.forEach(visit);
  };
  visit(root);
  return points;
}

function add_points({ geometry, matrixWorld }: Mesh, points: Vector3[]): void {
  const places = geometry.getAttribute("position");
  const index = geometry.index;
  const count = index?.count ?? places.count;
  const { a, b, c } = new Triangle();
  const corner = (out: Vector3, i: number): Vector3 =>
    out.fromBufferAttribute(places, index ? index.getX(i) : i).applyMatrix4(matrixWorld);
  for (let i = 0; i + 2 < count; i += 3) {
    corner(a, i);
    corner(b, i + 1);
    corner(c, i + 2);
    const longest = Math.max(a.distanceTo(b), b.distanceTo(c), c.distanceTo(a));
    const steps = Math.max(1, Math.ceil(longest / SPACING));
    for (let j = 0; j <= steps; j++) {
      for (let k = 0; j + k <= steps; k++) {
        const point = a.clone().multiplyScalar(1 - (j + k) / steps);
        points.push(point.addScaledVector(b, j / steps).addScaledVector(c, k / steps));
      }
    }
  }
}

// One of `points` per cube of this size, in their order.
export function thinned(points: Vector3[], size: number): Vector3[] {
  const seen = new Set<string>();
  return points.filter(({ x, y, z }) => {
    const cube = [x, y, z].map((value) => Math.round(value / size)).join();
    return !seen.has(cube) && seen.add(cube);
  });
}

// Which things (numbers 0 to 7) are in a cell.
export class Voxels {
  private readonly bounds: Box3;
  private readonly size: number;
  private readonly counts: [number, number, number];
  private readonly cells: Uint8Array;

  // `things[i]`: points on thing i.
  constructor(things: Vector3[][]) {
    this.bounds = new Box3();
    for (const points of things) for (const point of points) this.bounds.expandByPoint(point);
    const extent = this.bounds.getSize(new Vector3());
    const volume = extent.x * extent.y * extent.z;
    this.size = Math.max(CELL, Math.cbrt(volume / MOST_CELLS));
    this.counts = [extent.x, extent.y, extent.z].map(
      (length) => Math.floor(length / this.size) + 1,
    ) as [number, number, number];
    this.cells = new Uint8Array(this.counts[0] * this.counts[1] * this.counts[2]);
    for (const [thing, points] of things.entries()) {
      for (const { x, y, z } of points) this.cells[this.cell(x, y, z)]! |= 1 << thing;
    }
  }

  // Which things a ray from `from` to `eye` meets, as bits; thing i counts from `skip[i]` on, m.
  met(from: Vector3, eye: Vector3, skip: number[]): number {
    const along = eye.clone().sub(from);
    const length = along.length();
    along.divideScalar(length);
    let met = 0;
    let is_inside = false;
    for (let way = Math.min(...skip); way < length; way += STEP) {
      const x = from.x + way * along.x;
      const y = from.y + way * along.y;
      const z = from.z + way * along.z;
      const cell = this.cell(x, y, z);
      if (cell < 0 && is_inside) break; // out of everything
      if (cell < 0) continue;
      is_inside = true;
      const here = this.cells[cell]!;
      if (here === 0) continue;
      for (let thing = 0; thing < skip.length; thing++) {
        if (here & (1 << thing) && way >= skip[thing]!) met |= 1 << thing;
      }
    }
    return met;
  }

  // -1: outside.
  private cell(x: number, y: number, z: number): number {
    const { min, max } = this.bounds;
    if (x < min.x || y < min.y || z < min.z || x > max.x || y > max.y || z > max.z) return -1;
    const i = Math.floor((x - min.x) / this.size);
    const j = Math.floor((y - min.y) / this.size);
    const k = Math.floor((z - min.z) / this.size);
    return i + this.counts[0] * (j + this.counts[1] * k);
  }
}
