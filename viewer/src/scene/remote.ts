// The remote machine of a teleoperation: where it is, see-through where it is to be, its walls, and
// the force of its surroundings. A machine that is led by its joints has the links of the twin.

import { Group, type Object3D, Vector3 } from "three";

import type { Scene, SceneTeleoperation, Teleoperation, Vec3 } from "../messages";
import { FORCE_COLOR } from "../theme";
import type { ArrowSize } from "./arrow_size";
import { Bar, ForceArrow } from "./arrows";
import { type ChainView, load_chain } from "./chain_view";
import { REMOTE, glowing, paint_shapes, paint_target } from "./materials";
import { RemoteWalls } from "./remote_walls";
import { type Room, ToolMachine, room_of } from "./tool_machine";

const METRES_PER_NEWTON = 0.01;
const SMALLEST_FORCE = 0.5; // N; below it no arrow
const SMALLEST_WAY = 0.003; // m; nearer, no line leads to where it is to be

interface Machine {
  pose(x: number[]): void;
  readonly root: Object3D;
}

export class Remote {
  readonly group = new Group();
  private readonly base = new Group(); // at the base of the machine
  private readonly walls: RemoteWalls;
  private readonly force = new ForceArrow(glowing(FORCE_COLOR));
  private readonly way: Bar;

  private constructor(
    private readonly teleoperation: SceneTeleoperation,
    private readonly machine: Machine,
    private readonly target: Machine,
    arm: ChainView | null,
    room: Room | null,
    private readonly arrow: ArrowSize,
  ) {
    const [x, y, z, w] = teleoperation.quaternion_B_root;
    this.base.position.set(...teleoperation.p_B_root_m);
    this.base.quaternion.set(x, y, z, w);
    this.walls = new RemoteWalls(teleoperation, arm, room);
    this.way = new Bar(0.004, glowing(0xffffff));
    paint_target(this.way.mesh);
    this.force.group.scale.setScalar(arrow.share);
    this.force.group.visible = false;
    const moving = [machine.root, target.root];
    if (arm) this.group.add(...moving);
    else this.base.add(...moving);
    this.base.add(this.walls.group, this.way.mesh, this.force.group);
    this.group.add(this.base);
    this.target.root.visible = this.way.mesh.visible = false;
  }

  static async load(scene: Scene, arrow: ArrowSize): Promise<Remote | null> {
    const { teleoperation } = scene;
    if (!teleoperation) return null;
    if (teleoperation.mapping === "tool") {
      const room = room_of(teleoperation.axes);
      const machine = new ToolMachine(room, scene.floor_z_m - teleoperation.p_B_root_m[2]);
      const target = new ToolMachine(room, null);
      paint_target(target.group);
      return new Remote(teleoperation, as_machine(machine), as_machine(target), null, room, arrow);
    }
    const { p_B_root_m, quaternion_B_root } = teleoperation;
    const chain = { ...scene.twin, p_B_root_m, quaternion_B_root };
    const [arm, target] = await Promise.all([
      load_chain(chain, (root) => paint_shapes(root, REMOTE)),
      load_chain(chain, paint_target),
    ]);
    await Promise.all([arm.complete, target.complete]);
    return new Remote(teleoperation, as_arm(arm), as_arm(target), arm, null, arrow);
  }

  get machine_root(): Object3D {
    return this.machine.root;
  }

  get target_root(): Object3D {
    return this.target.root;
  }

  get walls_group(): Object3D {
    return this.walls.group;
  }

  show(now: Teleoperation | null): void {
    if (!now) return;
    const is_known = now.x_remote.length > 0;
    if (is_known) this.machine.pose(now.x_remote);
    const is_led = is_known && now.link === "engaged" && now.x_target.length > 0;
    this.target.root.visible = is_led;
    if (is_led) this.target.pose(now.x_target);
    this.walls.show(now.f_remote);
    if (this.teleoperation.mapping === "tool") this.show_tool(now, is_led);
  }

  private show_tool({ x_remote, x_target, f_remote }: Teleoperation, is_led: boolean): void {
    const [is, to_be] = [point(x_remote), point(x_target)];
    this.way.mesh.visible = is_led && is.distanceTo(to_be) > SMALLEST_WAY;
    if (this.way.mesh.visible) this.way.span(is, to_be);
    this.force.group.visible = f_remote.length >= 3;
    if (f_remote.length < 3) return;
    const { share, longest_m } = this.arrow;
    const [at, force] = [is.toArray() as Vec3, f_remote.slice(0, 3) as Vec3];
    this.force.show(at, force, METRES_PER_NEWTON / share, SMALLEST_FORCE, longest_m / share);
  }
}

// The place of a tool; the turn of one that is turned stands behind it.
function point([x = 0, y = 0, z = 0]: number[]): Vector3 {
  return new Vector3(x, y, z);
}

function as_machine(tool: ToolMachine): Machine {
  return { root: tool.group, pose: (x) => tool.pose(x) };
}

function as_arm(arm: ChainView): Machine {
  return { root: arm.placement, pose: (x) => arm.pose(x) };
}
