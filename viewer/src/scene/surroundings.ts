// What stands around the twin: a wall for the door, a site for the excavator, a room for a body
// that moves freely. None of it can be felt; it says where one is.

import {
  BufferAttribute,
  CircleGeometry,
  ConeGeometry,
  CylinderGeometry,
  BoxGeometry,
  DoubleSide,
  Group,
  type Material,
  Mesh,
  MeshStandardMaterial,
  type Object3D,
  PlaneGeometry,
  RingGeometry,
  type Vector3,
} from "three";

import type { Scene, SceneChain } from "../messages";
import type { Theme } from "../theme";
import { foot_of_arm } from "./first_view";
import { put_at_root } from "./root";

// Height of things that lie flat on the floor above it, m: what lies higher is drawn over the rest.
const FLAT = 0.004;
const OWN_FOOT = 0.2; // m, below where an arm stands: it brings what it stands on
const PLATE = { wide: 0.36, thick: 0.03 }; // m, under an arm

export interface Surroundings {
  group: Group;
  wall?: Group; // what may hide the device
  is_at_twin?: boolean; // it goes where the root link of the twin goes
  paint(theme: Theme): void;
}

// `lowest_z_m`: of what the device itself has, a table perhaps.
export function surroundings_of(scene: Scene, lowest_z_m: number): Surroundings {
  if (scene.environment === "door") return wall(scene.twin, scene.floor_z_m);
  if (scene.environment === "excavator") return site(scene.twin, scene.floor_z_m);
  const foot = foot_of_arm(scene);
  const has_table = foot !== null && lowest_z_m < foot.z - OWN_FOOT;
  if (foot) return stand(foot, has_table ? foot.z : scene.floor_z_m);
  return room(scene.floor_z_m);
}

// What an arm stands on.
function stand({ x, y, z }: Vector3, floor_z: number): Surroundings {
  const group = new Group();
  const height = z - floor_z;
  if (height > 2 * PLATE.thick) {
    const metal = matt(0x8d99a6);
    const plate = new BoxGeometry(PLATE.wide, PLATE.wide, PLATE.thick);
    add(group, lit(new Mesh(plate, metal)), x, y, z - 0.5 * PLATE.thick);
    const column = new CylinderGeometry(0.09, 0.12, height - PLATE.thick, 32).rotateX(Math.PI / 2);
    add(group, lit(new Mesh(column, metal)), x, y, 0.5 * (z - PLATE.thick + floor_z));
  }
  return { group, paint: () => {} };
}

function at_twin(twin: SceneChain): Group {
  const group = new Group();
  put_at_root(group, twin);
  return group;
}

function add<T extends Object3D>(group: Group, shape: T, x: number, y: number, z: number): T {
  shape.position.set(x, y, z);
  group.add(shape);
  return shape;
}

function matt(color: number, more: { opacity?: number } = {}): MeshStandardMaterial {
  const transparent = more.opacity !== undefined;
  return new MeshStandardMaterial({ color, roughness: 0.9, transparent, ...more });
}

function lit<T extends Object3D>(shape: T): T {
  shape.traverse((part) => (part.castShadow = part.receiveShadow = true));
  return shape;
}

// A wall left, right and above the frame that fades out to its sides, so that the device behind
// it stays visible. Frame of the door: models/twins/door/door.urdf.
function wall(twin: SceneChain, floor_z: number): Surroundings {
  const group = at_twin(twin);
  const foot = floor_z - twin.p_B_root_m[2];
  const [left, right, lintel, top, reach] = [-0.08, 1.0, 1.025, 1.3, 1.15];
  const material = new MeshStandardMaterial({
    vertexColors: true,
    transparent: true,
    roughness: 0.95,
    side: DoubleSide,
    depthWrite: false,
  });
  const height = top - foot;
  const middle = 0.5 * (top + foot);
  const panels: [number, number, number, number][] = [
    [left - 0.5 * reach, middle, reach, height],
    [right + 0.5 * reach, middle, reach, height],
    [0.5 * (left + right), 0.5 * (lintel + top), right - left, top - lintel],
  ];
  for (const y of [-0.05, 0.05]) {
    for (const [x, z, width, tall] of panels) {
      const shape = new PlaneGeometry(width, tall, Math.ceil(width / 0.1), 1).rotateX(Math.PI / 2);
      fade(shape, (at) => {
        const outside = Math.max(left - (at + x), at + x - right, 0);
        return 0.62 * Math.max(0, 1 - outside / reach) ** 1.6;
      });
      add(group, new Mesh(shape, material), x, y, z).receiveShadow = true;
    }
  }
  return { group, wall: group, is_at_twin: true, paint: (theme) => void material.color.set(theme.wall) };
}

// Gives the points of `shape` an opacity by their x.
function fade(shape: PlaneGeometry, opacity: (x: number) => number): void {
  const places = shape.getAttribute("position");
  const colors = new Float32Array(4 * places.count);
  for (let i = 0; i < places.count; i++) colors.set([1, 1, 1, opacity(places.getX(i))], 4 * i);
  shape.setAttribute("color", new BufferAttribute(colors, 4));
}

// Earth under the tracks, a heap to dig in, cones and a barrier.
function site(twin: SceneChain, floor_z: number): Surroundings {
  const group = at_twin(twin);
  const foot = floor_z - twin.p_B_root_m[2];
  const earth = matt(0x8a6a48);
  const ground = new Mesh(disc(2.5, 0.22), matt(0x9a8161));
  add(group, ground, 0.75, 0, foot + FLAT).receiveShadow = true;
  add(group, lit(new Mesh(heap(0.95, 0.5), earth)), 1.75, 0, foot);
  add(group, lit(new Mesh(heap(0.5, 0.28), earth)), 1.3, 0.95, foot);
  add(group, lit(new Mesh(heap(0.36, 0.2), earth)), 1.25, -0.9, foot);
  for (const [x, y] of [
    [-0.9, 1.35],
    [0.35, 1.95],
    [-0.9, -1.35],
    [0.35, -1.95],
  ] as const) {
    add(group, cone(), x, y, foot);
  }
  return { group, is_at_twin: true, paint: () => {} };
}

// A disc with an uneven rim.
function disc(radius: number, unevenness: number): CircleGeometry {
  const shape = new CircleGeometry(radius, 48);
  const places = shape.getAttribute("position");
  for (let i = 1; i < places.count; i++) {
    const [x, y] = [places.getX(i), places.getY(i)];
    const share = 1 + (unevenness / radius) * ripple(Math.atan2(y, x), 3);
    places.setXY(i, x * share, y * share);
  }
  return shape;
}

// A heap of earth, z up.
function heap(radius: number, height: number): ConeGeometry {
  const shape = new ConeGeometry(radius, height, 40, 8, true);
  const places = shape.getAttribute("position");
  for (let i = 0; i < places.count; i++) {
    const [x, y, z] = [places.getX(i), places.getY(i), places.getZ(i)];
    const out = Math.min(1, Math.hypot(x, z) / radius); // 0 at the top, 1 at the rim
    const angle = Math.atan2(z, x);
    const share = 1 + 0.1 * out * ripple(angle, 4);
    const round = height * Math.max(0, Math.cos(0.5 * Math.PI * out)) ** 1.3;
    places.setXYZ(
      i,
      x * share,
      round * (1 + 0.06 * ripple(angle + 3 * y, 6)) - 0.01 * out,
      z * share,
    );
  }
  shape.rotateX(Math.PI / 2);
  shape.computeVertexNormals();
  return shape;
}

function ripple(angle: number, waves: number): number {
  return 0.5 * Math.sin(waves * angle + 1) + 0.5 * Math.sin((waves + 3) * angle + 2.4);
}

function cone(): Group {
  const group = new Group();
  const orange = matt(0xee6a1f);
  const white = matt(0xf4f4f2);
  add(group, new Mesh(new BoxGeometry(0.34, 0.34, 0.03), orange), 0, 0, 0.015);
  const part = (low: number, high: number, material: Material): void => {
    const radius = (z: number): number => 0.13 * (1 - z / 0.62) + 0.015;
    const shape = new CylinderGeometry(radius(high), radius(low), high - low, 24);
    add(group, new Mesh(shape.rotateX(Math.PI / 2), material), 0, 0, 0.5 * (low + high));
  };
  part(0.03, 0.22, orange);
  part(0.22, 0.32, white);
  part(0.32, 0.42, orange);
  part(0.42, 0.5, white);
  part(0.5, 0.58, orange);
  return lit(group);
}

// Rings on the floor to walk on.
function room(floor_z: number): Surroundings {
  const group = new Group();
  const material = matt(0x3f86c6, { opacity: 0.35 });
  material.depthWrite = false;
  for (const radius of [0.45, 0.9, 1.35]) {
    const ring = new Mesh(new RingGeometry(radius - 0.012, radius + 0.012, 96), material);
    add(group, ring, 0, 0, floor_z + FLAT);
  }
  for (let i = 0; i < 12; i++) {
    const tick = new Mesh(new PlaneGeometry(i % 3 === 0 ? 0.16 : 0.08, 0.02), material);
    const angle = (i * Math.PI) / 6;
    add(group, tick, 1.5 * Math.cos(angle), 1.5 * Math.sin(angle), floor_z + FLAT);
    tick.rotation.z = angle;
  }
  const carpet = new Mesh(new CircleGeometry(1.35, 96), matt(0x3f86c6, { opacity: 0.08 }));
  (carpet.material as Material).depthWrite = false;
  add(group, carpet, 0, 0, floor_z + 0.5 * FLAT).receiveShadow = true;
  return { group, paint: (theme) => void material.color.set(theme.is_dark ? 0x76b4ec : 0x3f86c6) };
}
