// What a remote machine meets: planes before a tool, sectors at the joints of an arm. The one that
// is pressed lights up.

import {
  BoxGeometry,
  type BufferGeometry,
  DoubleSide,
  EdgesGeometry,
  ExtrudeGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshStandardMaterial,
  Shape,
  Vector3,
} from "three";

import type { SceneTeleoperation, SceneWall } from "../messages";
import { CONTACT_COLOR, SURFACE_COLOR } from "../theme";
import type { ChainView } from "./chain_view";
import { stand_at } from "./joint_gauges";
import type { Room } from "./tool_machine";

const THICK = 0.04; // m
const PRESSED = 0.5; // N or Nm
const SECTOR = { turn: 0.35, inside: 0.3, outside: 0.85 }; // rad, m

export class RemoteWalls {
  readonly group = new Group();
  private readonly materials: MeshStandardMaterial[] = [];

  // `arm`: whose joints meet the walls; else a tool in its `room` does.
  constructor(
    private readonly teleoperation: SceneTeleoperation,
    arm: ChainView | null,
    room: Room | null,
  ) {
    for (const wall of teleoperation.walls) {
      const part = this.solid(arm ? sector(wall) : plate(wall, room!));
      if (!arm) this.place(part, wall, room!);
      else this.place_at_joint(part, wall, arm);
    }
  }

  show(force: number[]): void {
    for (const [i, { normal }] of this.teleoperation.walls.entries()) {
      const along = normal.reduce((sum, part, axis) => sum + part * (force[axis] ?? 0), 0);
      const is_pressed = along > PRESSED;
      this.materials[i]!.color.set(is_pressed ? CONTACT_COLOR : SURFACE_COLOR);
      this.materials[i]!.opacity = is_pressed ? 0.7 : 0.45;
    }
  }

  private solid(shape: BufferGeometry): Mesh {
    const material = new MeshStandardMaterial({
      color: SURFACE_COLOR,
      roughness: 0.6,
      transparent: true,
      opacity: 0.45,
      side: DoubleSide,
      depthWrite: false,
    });
    this.materials.push(material);
    const part = new Mesh(shape, material);
    part.add(new LineSegments(new EdgesGeometry(shape, 20), new LineBasicMaterial({ color: SURFACE_COLOR })));
    return part;
  }

  private place(part: Mesh, { normal, offset }: SceneWall, { low, high }: Room): void {
    const out = new Vector3(...(normal as [number, number, number]));
    const middle = low.clone().add(high).multiplyScalar(0.5);
    part.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), out);
    part.position.copy(middle).addScaledVector(out, offset - 0.5 * THICK - middle.dot(out));
    this.group.add(part);
  }

  private place_at_joint(part: Mesh, { normal }: SceneWall, arm: ChainView): void {
    const axis = normal.findIndex((share) => Math.abs(share) > 0.5);
    const joint = arm.joint(this.teleoperation.axes[axis]?.name ?? "");
    if (joint) stand_at(joint, [part]);
  }
}

function plate({ normal }: SceneWall, { low, high }: Room): BufferGeometry {
  const size = high.clone().sub(low);
  const along = normal.map((share, i) => (1 - Math.abs(share)) * size.getComponent(i));
  const wide = Math.max(...along);
  return new BoxGeometry(wide, wide, THICK);
}

// Behind the position of the joint at which it meets the wall, about its axis z.
function sector({ normal, offset }: SceneWall): BufferGeometry {
  const sign = normal.reduce((sum, part) => sum + part, 0) < 0 ? -1 : 1;
  const at = sign * offset;
  const end = at - sign * SECTOR.turn;
  const shape = new Shape();
  shape.absarc(0, 0, SECTOR.outside, Math.min(at, end), Math.max(at, end), false);
  shape.absarc(0, 0, SECTOR.inside, Math.max(at, end), Math.min(at, end), true);
  return new ExtrudeGeometry(shape, { depth: 0.3, bevelEnabled: false, curveSegments: 24 }).translate(0, 0, -0.15);
}
