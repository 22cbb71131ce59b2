// Where the handle may go, so that a first view has room for it.

import { Box3, Vector3 } from "three";

import type { Frame, Scene, SceneJoint } from "../messages";
import type { ChainView } from "./chain_view";

const MOST_JOINTS = 4; // of a twin whose ends are tried
const ROOMY = 0.6; // share of the box that a body moves in mostly

// With the joints of the twin, or all over the box of the handle; and all checkpoints.
export function ways_of_handle(scene: Scene, frame: Frame, twin: ChainView): Vector3[] {
  const room = new Box3(new Vector3(...scene.box.min_m), new Vector3(...scene.box.max_m));
  const marks = scene.checkpoints.map(({ x_m, y_m }) => new Vector3(x_m, y_m, scene.floor_z_m));
  return [...marks, ...(by_joints(scene.twin.joints, frame, twin, room) ?? corners(room))];
}

// null: the twin has joints without ends, or too many.
function by_joints(joints: SceneJoint[], frame: Frame, twin: ChainView, room: Box3): Vector3[] | null {
  const last = joints.length > 0 ? twin.joint(joints.at(-1)!.name) : null;
  const ranges = joints.map(range_of);
  if (!last || joints.length > MOST_JOINTS || ranges.includes(null)) return null;
  twin.placement.updateWorldMatrix(true, true);
  const handle = last.worldToLocal(new Vector3(...frame.p_B_H_m));
  const ways = combinations(ranges as number[][]).map((q) => {
    twin.pose(q, frame.twin_base);
    twin.placement.updateWorldMatrix(true, true);
    const place = last.localToWorld(handle.clone());
    return room.clampPoint(place, place);
  });
  twin.pose(frame.q_twin, frame.twin_base);
  return ways;
}

function range_of({ type, q_min, q_max }: SceneJoint): number[] | null {
  if (type === "floating" || q_min === null || q_max === null) return null;
  return [q_min, 0.5 * (q_min + q_max), q_max];
}

function combinations(ranges: number[][]): number[][] {
  return ranges.reduce<number[][]>(
    (all, range) => all.flatMap((q) => range.map((value) => [...q, value])),
    [[]],
  );
}

function corners(room: Box3): Vector3[] {
  const middle = room.getCenter(new Vector3());
  const { x, y, z } = room.getSize(new Vector3()).multiplyScalar(0.5 * ROOMY);
  const signs = [-1, 1];
  return signs.flatMap((i) =>
    signs.flatMap((j) =>
      signs.map((k) => new Vector3(i * x, j * y, k * z).add(middle)),
    ),
  );
}
