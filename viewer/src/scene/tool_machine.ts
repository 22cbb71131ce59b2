// A machine with three straight axes that moves a tool: a portal over its range. Coordinates are
// those of the tool in the frame of its base.

import { BoxGeometry, CylinderGeometry, Group, Mesh, MeshStandardMaterial, SphereGeometry, Vector3 } from "three";

import type { SceneAxis } from "../messages";
import { REMOTE_COLOR } from "../theme";

const WITHOUT_END = 0.5; // m, of an axis that has no ends
const BEAM = 0.05; // m
const ABOVE = 0.16; // m, of the portal over the range
const TOOL = { radius: 0.035, length: 0.16 }; // m

export interface Room {
  low: Vector3;
  high: Vector3;
}

export function room_of(axes: SceneAxis[]): Room {
  const ends = (of: (axis: SceneAxis) => number): Vector3 =>
    new Vector3(...(axes.slice(0, 3).map(of) as [number, number, number]));
  return {
    low: ends(({ min }) => min ?? -WITHOUT_END),
    high: ends(({ max }) => max ?? WITHOUT_END),
  };
}

export class ToolMachine {
  readonly group = new Group();
  private readonly bridge = new Group(); // moves along x
  private readonly carriage = new Group(); // along y on the bridge
  private readonly column: Mesh; // along z
  private readonly tool = new Group();
  private readonly top: number;

  // `floor_z`: in the frame of the base; null: without what stands still.
  constructor(room: Room, floor_z: number | null) {
    const { low, high } = room;
    this.top = high.z + ABOVE;
    const middle = low.clone().add(high).multiplyScalar(0.5);
    const size = high.clone().sub(low);
    if (floor_z !== null) this.add_portal(room, floor_z);
    add(this.bridge, box(1.3 * BEAM, size.y + 2 * BEAM, BEAM), 0, middle.y, this.top);
    add(this.carriage, box(2.6 * BEAM, 2.6 * BEAM, 1.8 * BEAM), 0, 0, this.top);
    this.column = add(this.carriage, box(BEAM, BEAM, 1), 0, 0, 0);
    const { radius, length } = TOOL;
    const shaft = new CylinderGeometry(0.4 * radius, 0.6 * radius, length, 20).rotateX(Math.PI / 2);
    add(this.tool, new Mesh(shaft, metal()), 0, 0, 0.5 * length);
    add(this.tool, new Mesh(new SphereGeometry(radius, 28, 18), painted()), 0, 0, 0);
    this.group.add(this.bridge, this.carriage, this.tool);
    this.group.traverse((part) => (part.castShadow = part.receiveShadow = true));
    this.pose(middle.toArray());
  }

  pose([x, y, z]: number[]): void {
    if (x === undefined || y === undefined || z === undefined) return;
    this.bridge.position.x = this.carriage.position.x = x;
    this.carriage.position.y = y;
    this.tool.position.set(x, y, z);
    const [from, to] = [z + TOOL.length, this.top];
    this.column.scale.z = Math.max(0.01, to - from);
    this.column.position.z = 0.5 * (from + to);
  }

  // Two rails on four legs.
  private add_portal({ low, high }: Room, floor_z: number): void {
    const [x, length] = [0.5 * (low.x + high.x), high.x - low.x];
    for (const y of [low.y - BEAM, high.y + BEAM]) {
      add(this.group, box(length + 2 * BEAM, BEAM, BEAM), x, y, this.top - BEAM);
      for (const end of [low.x - 0.5 * BEAM, high.x + 0.5 * BEAM]) {
        const tall = this.top - BEAM - floor_z;
        add(this.group, box(BEAM, BEAM, tall), end, y, floor_z + 0.5 * tall);
      }
    }
  }
}

function painted(): MeshStandardMaterial {
  return new MeshStandardMaterial({ color: REMOTE_COLOR, roughness: 0.5, metalness: 0.05 });
}

function metal(): MeshStandardMaterial {
  return new MeshStandardMaterial({ color: 0xb7bfc7, roughness: 0.35, metalness: 0.7 });
}

function box(x: number, y: number, z: number): Mesh {
  return new Mesh(new BoxGeometry(x, y, z), painted());
}

function add(group: Group, part: Mesh, x: number, y: number, z: number): Mesh {
  part.position.set(x, y, z);
  group.add(part);
  return part;
}
