// The first view: from where device, twin, hand and force are all seen. Directions around the
// handle are tried in a fixed order, each at the distance at which everything is in the picture;
// the one in which they hide each other least, and are seen largest, is taken.

import { MathUtils, type PerspectiveCamera, Vector3 } from "three";

import type { Scene } from "../messages";
import { Voxels, thinned } from "./voxels";

export interface Sight {
  from: Vector3;
  at: Vector3;
}

// What there is to see, as points on its surfaces.
export interface Sights {
  arm: Vector3[]; // of the device, what moves with the hand
  frame: Vector3[]; // the rest of the device: a gantry, a table
  twin: Vector3[];
  person: Vector3[]; // without the hand that holds
  around: Vector3[]; // walls, a table
  handle: Vector3;
  to_user: Vector3; // axis of the hand
  arrow: number; // m, the longest one
  room: Vector3[]; // what else must be in the picture: where the handle may go, a table
}

// Where an arm without a gantry stands; null: the device hangs above the person.
export function foot_of_arm(scene: Scene): Vector3 | null {
  return scene.gantry_joints === 0 ? new Vector3(...scene.device.p_B_root_m) : null;
}

// Share of the picture, from its middle, that what matters fills: notes lie at its top and bottom.
const FILLED = { side: 0.9, top: 0.84, bottom: 0.8 };
const AZIMUTHS = 24;
const ELEVATIONS = [15, 21, 28, 36]; // degrees; flatter, a drag would not be level
const LIKED_ELEVATION = 18;

const THINGS = ["arm", "frame", "twin", "person", "around"] as const;
const SOLIDITY = [1, 1, 0.85, 0.75, 0.5]; // of THINGS, about as they are drawn
// What lies closer to a point of this kind does not hide it: it belongs to it, m.
const BESIDE_HANDLE = [0.13, 0.04, 0.04, 0.16, 0.04];
const BESIDE = 0.06;
const ROUND_HANDLE = 0.03; // m
const SAMPLE = 0.12; // m between points whose sight is asked for
const OUTLINE = 0.06; // m between points that must be in the picture
const RASTER = 40; // cells across a picture, for the area that a thing covers

const WORTH = {
  handle: 6,
  arm: 4,
  twin: 1.5,
  person: 0.5,
  arm_area: 1.5,
  twin_area: 1,
  person_area: 0.3,
  arrow: 1, // seen from its side
  usual_side: 0.25, // from where y is small, as the box of the handle is seen
  steepness: 0.6, // per 20 degrees
};

// Unit vectors to the camera, in the order in which they are tried.
function directions(): Vector3[] {
  const all: Vector3[] = [];
  for (const elevation of ELEVATIONS) {
    for (let i = 0; i < AZIMUTHS; i++) {
      const [up, around] = [MathUtils.degToRad(elevation), (2 * Math.PI * i) / AZIMUTHS];
      const level = Math.cos(up);
      all.push(new Vector3(-level * Math.sin(around), -level * Math.cos(around), Math.sin(up)));
    }
  }
  return all;
}

// The camera that looks against `towards` and has all `points` in the picture, as near as it can.
export function fitted(points: Vector3[], towards: Vector3, camera: PerspectiveCamera): Sight {
  const right = new Vector3(-towards.y, towards.x, 0).normalize();
  const up = new Vector3().crossVectors(towards, right);
  const tall = Math.tan(0.5 * MathUtils.degToRad(camera.fov));
  const wide = tall * camera.aspect * FILLED.side;
  const [top, bottom] = [tall * FILLED.top, tall * FILLED.bottom];
  let [rightmost, leftmost, highest, lowest] = [-Infinity, Infinity, -Infinity, Infinity];
  for (const point of points) {
    const [x, y, z] = [point.dot(right), point.dot(up), point.dot(towards)];
    rightmost = Math.max(rightmost, x + wide * z);
    leftmost = Math.min(leftmost, x - wide * z);
    highest = Math.max(highest, y + top * z);
    lowest = Math.min(lowest, y - bottom * z);
  }
  const away = Math.max((rightmost - leftmost) / (2 * wide), (highest - lowest) / (top + bottom));
  const x = 0.5 * (rightmost + leftmost);
  const y = 0.5 * (highest - top * away + lowest + bottom * away);
  const from = new Vector3().addScaledVector(right, x).addScaledVector(up, y);
  const depth = points.reduce((sum, point) => sum + point.dot(towards), 0) / points.length;
  const at = from.clone().addScaledVector(towards, depth);
  return { from: from.addScaledVector(towards, away), at };
}

export class FirstView {
  private readonly outline: Vector3[];
  private readonly voxels: Voxels;
  private readonly samples: Vector3[][]; // arm, twin, person
  private readonly handles: Vector3[];
  private towards: Vector3 | null = null;

  constructor(private readonly sights: Sights) {
    const { arm, frame, twin, person, around, handle, arrow, room } = sights;
    this.voxels = new Voxels([arm, frame, twin, person, around]);
    this.samples = [arm, twin, person].map((points) => thinned(points, SAMPLE));
    this.handles = [handle, ...beside(handle, ROUND_HANDLE)];
    const seen = [arm, twin, person].flatMap((points) => extremes(thinned(points, OUTLINE)));
    this.outline = [...seen, ...beside(handle, arrow), ...extremes(room)];
  }

  // The best view of a picture of the camera's shape. Its direction is chosen once: a picture that
  // changes its size does not turn the camera.
  sight(camera: PerspectiveCamera): Sight {
    this.towards ??= this.best_direction(camera);
    return fitted(this.outline, this.towards, camera);
  }

  private best_direction(camera: PerspectiveCamera): Vector3 {
    const views = directions().map((towards) => this.judge(towards, camera));
    const largest = [0, 1, 2].map((i) => Math.max(1, ...views.map(({ areas }) => areas[i]!)));
    const whole = views.map(({ worth, areas }) => {
      const [arm, twin, person] = areas.map((area, i) => Math.sqrt(area / largest[i]!));
      const { arm_area, twin_area, person_area } = WORTH;
      return worth + arm_area * arm! + twin_area * twin! + person_area * person!;
    });
    return views[whole.indexOf(Math.max(...whole))]!.towards;
  }

  private judge(towards: Vector3, camera: PerspectiveCamera): View {
    const { from } = fitted(this.outline, towards, camera);
    const [arm, twin, person] = this.samples as [Vector3[], Vector3[], Vector3[]];
    const { to_user } = this.sights;
    const elevation = MathUtils.radToDeg(Math.asin(towards.z));
    const worth =
      WORTH.handle * this.seen_share(this.handles, from, BESIDE_HANDLE) +
      WORTH.arm * this.seen_share(arm, from, besides("arm")) +
      WORTH.twin * this.seen_share(twin, from, besides("twin")) +
      WORTH.person * this.seen_share(person, from, besides("person")) +
      WORTH.arrow * Math.sqrt(1 - Math.min(1, towards.dot(to_user) ** 2)) -
      WORTH.usual_side * towards.y -
      (WORTH.steepness * Math.abs(elevation - LIKED_ELEVATION)) / 20;
    const areas = this.samples.map((points) => covered(points, from, towards, camera));
    return { towards, worth, areas };
  }

  // How much of `points` is seen from `eye`, 0..1.
  private seen_share(points: Vector3[], eye: Vector3, skip: number[]): number {
    if (points.length === 0) return 1;
    let sum = 0;
    for (const point of points) {
      const met = this.voxels.met(point, eye, skip);
      sum += SOLIDITY.reduce((light, solid, i) => (met & (1 << i) ? light * (1 - solid) : light), 1);
    }
    return sum / points.length;
  }
}

interface View {
  towards: Vector3;
  worth: number;
  areas: number[]; // of the samples, in cells of the raster
}

// What may hide a point of `owner`: all but itself.
function besides(owner: (typeof THINGS)[number]): number[] {
  return THINGS.map((thing) => (thing === owner ? Infinity : BESIDE));
}

function beside(point: Vector3, away: number): Vector3[] {
  const axes = [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)];
  return axes.flatMap((axis) =>
    [-away, away].map((length) => point.clone().addScaledVector(axis, length)),
  );
}

// Of many points those that may lie at the edge of a picture.
function extremes(points: Vector3[]): Vector3[] {
  const found = new Set<Vector3>();
  for (const towards of directions()) {
    const right = new Vector3(-towards.y, towards.x, 0);
    for (const axis of [towards, right, new Vector3().crossVectors(towards, right)]) {
      let [low, high]: [Vector3 | null, Vector3 | null] = [null, null];
      for (const point of points) {
        if (!low || point.dot(axis) < low.dot(axis)) low = point;
        if (!high || point.dot(axis) > high.dot(axis)) high = point;
      }
      if (low && high) found.add(low).add(high);
    }
  }
  return [...found];
}

// Number of cells of the picture in which one of `points` is.
function covered(
  points: Vector3[],
  eye: Vector3,
  towards: Vector3,
  camera: PerspectiveCamera,
): number {
  const right = new Vector3(-towards.y, towards.x, 0).normalize();
  const up = new Vector3().crossVectors(towards, right);
  const scale = RASTER / (2 * Math.tan(0.5 * MathUtils.degToRad(camera.fov)));
  const cells = new Set<number>();
  for (const point of points) {
    const out = point.clone().sub(eye);
    const depth = -out.dot(towards);
    const x = Math.round((scale * out.dot(right)) / depth);
    const y = Math.round((scale * out.dot(up)) / depth);
    cells.add(1000 * x + y);
  }
  return cells.size;
}
