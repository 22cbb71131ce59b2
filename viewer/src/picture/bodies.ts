// The bodies of a run for flat pictures: where their outer points are now.

import { type Material, Mesh, type Object3D, Vector3 } from "three";

import type { Frame, Scene, Vec3 } from "../messages";
import { type ChainView, load_chain } from "../scene/chain_view";
import { MovingBaseView } from "../scene/moving_base";
import { Remote } from "../scene/remote";
import { put_at_root } from "../scene/root";
import { SurfacesView } from "../scene/surfaces";
import { type Surroundings, surroundings_of } from "../scene/surroundings";
import { outer_points } from "./outline";

export type Kind = "device" | "twin" | "remote" | "target" | "base" | "surface" | "wall";

export interface Body {
  kind: Kind;
  is_touched: boolean; // a surface that pushes
  points: Vec3[]; // outer ones, in B
}

const as_is = (): void => {};
const NO_ARROW = { share: 1, longest_m: 0 };

export class Bodies {
  private readonly groups: [Kind, Object3D][]; // that may not move
  private readonly surroundings: Surroundings;
  private readonly base: MovingBaseView | null;
  private fixed: Body[] | null = null;

  private constructor(
    readonly scene: Scene,
    private readonly device: ChainView,
    private readonly twin: ChainView,
    private readonly remote: Remote | null,
  ) {
    const surfaces = new SurfacesView(scene.surfaces);
    surfaces.show([0, 0, 0], null);
    this.surroundings = surroundings_of(scene, scene.floor_z_m);
    this.base = scene.twin_base_moves ? new MovingBaseView(scene.twin, scene.floor_z_m) : null;
    this.groups = [["surface", surfaces.group]];
    if (!this.moves_surroundings) this.groups.unshift(["wall", this.surroundings.group]);
  }

  static async load(scene: Scene): Promise<Bodies> {
    const [device, twin, remote] = await Promise.all([
      load_chain(scene.device, as_is),
      load_chain(scene.twin, as_is),
      Remote.load(scene, NO_ARROW),
    ]);
    return new Bodies(scene, device, twin, remote);
  }

  pose(frame: Frame): void {
    this.device.pose(frame.q_device);
    this.twin.pose(frame.q_twin, frame.twin_base);
    this.base?.show(frame.twin_base);
    if (this.moves_surroundings) put_at_root(this.surroundings.group, this.scene.twin, frame.twin_base);
    this.remote?.show(frame.teleoperation);
  }

  // What lies behind first.
  list(contact: Frame["contact"]): Body[] {
    this.fixed ??= this.groups.flatMap(([kind, group]) => bodies_of(kind, group));
    const surfaces = this.fixed.filter(({ kind }) => kind === "surface");
    for (const [i, body] of surfaces.entries()) body.is_touched = contact?.surface === i;
    return [
      ...(this.moves_surroundings ? bodies_of("wall", this.surroundings.group) : []),
      ...(this.base ? bodies_of("base", this.base.group) : []),
      ...this.fixed,
      ...this.remote_bodies(),
      ...bodies_of("twin", this.twin.placement),
      ...bodies_of("device", this.device.placement),
    ];
  }

  private get moves_surroundings(): boolean {
    return this.base !== null && this.surroundings.is_at_twin === true;
  }

  private remote_bodies(): Body[] {
    if (!this.remote) return [];
    return [
      ...bodies_of("surface", this.remote.walls_group),
      ...bodies_of("target", this.remote.target_root),
      ...bodies_of("remote", this.remote.machine_root),
    ];
  }
}

function bodies_of(kind: Kind, root: Object3D): Body[] {
  root.updateMatrixWorld(true);
  const bodies: Body[] = [];
  root.traverseVisible((part) => {
    if (!(part instanceof Mesh) || (part.material as Material).visible === false) return;
    const points = outer_points(part.geometry).map((point) =>
      new Vector3().copy(point).applyMatrix4(part.matrixWorld).toArray(),
    );
    bodies.push({ kind, is_touched: false, points: points as Vec3[] });
  });
  return bodies;
}
