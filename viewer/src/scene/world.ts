// Everything that is drawn of one run: made from its Scene, moved by its Frames.

import { Box3, Group, type Object3D, Quaternion, Vector3 } from "three";

import { limit_closeness } from "../limit_words";
import type { Frame, Scene, Vec3 } from "../messages";
import { ELBOW_COLOR, FORCE_COLOR, type Theme } from "../theme";
import { type ArrowSize, arrow_size } from "./arrow_size";
import { Checkpoints } from "./checkpoints";
import { type ChainView, load_chain } from "./chain_view";
import { add_shapes } from "./collision_shapes";
import { dispose_of } from "./dispose";
import { type Sights, foot_of_arm } from "./first_view";
import { Ghost } from "./ghost";
import { HandleView } from "./handle_view";
import { JointGauge } from "./joint_gauges";
import type { Layer, Layers } from "./layers";
import { DEVICE, TWIN, paint_shapes } from "./materials";
import { MovingBaseView } from "./moving_base";
import { Person } from "./person";
import { Remote } from "./remote";
import { put_at_root } from "./root";
import { scanner_zone } from "./scanner_zone";
import type { Stage } from "./stage";
import { SeeThrough } from "./see_through";
import { SurfacesView } from "./surfaces";
import { type Surroundings, surroundings_of } from "./surroundings";
import { Trail } from "./trail";
import { points_on, thinned } from "./voxels";
import { ways_of_handle } from "./ways";

const TABLE_POINTS = 0.2; // m between them
const MOST_STEP_S = 1; // a longer one, or one back, is to another place of a recording: trails begin there

interface Gauge {
  view: JointGauge;
  coordinate: number; // in q_device
  limit: number; // in Scene.limits, -1 = none
}

export class World {
  readonly root = new Group();
  readonly person: Person;
  private readonly arrow: ArrowSize;
  private readonly handle: HandleView;
  private readonly handle_trail = new Trail(FORCE_COLOR);
  private readonly elbow_trail = new Trail(ELBOW_COLOR);
  private readonly both_trails = [this.handle_trail, this.elbow_trail];
  private readonly trails = new Group();
  private noted_s = 0;
  private readonly gauges: Gauge[];
  private readonly surroundings: Surroundings;
  private readonly base: MovingBaseView | null;
  private readonly surfaces: SurfacesView;
  private readonly checkpoints: Checkpoints;
  private readonly scanner: Group;
  private readonly shapes: Object3D[];
  private readonly ghost: Ghost;
  private readonly see_through = new SeeThrough();

  private constructor(
    readonly scene: Scene,
    private readonly device: ChainView,
    private readonly twin: ChainView,
    private readonly remote: Remote | null,
    private readonly stage: Stage,
    private readonly layers: Layers,
  ) {
    this.arrow = arrow_of(scene, device);
    this.handle = new HandleView(this.arrow);
    this.person = new Person(scene.floor_z_m, foot_of_arm(scene));
    const lowest = new Box3().setFromObject(device.placement).min.z;
    this.surroundings = surroundings_of(scene, lowest);
    this.base = scene.twin_base_moves ? new MovingBaseView(scene.twin, scene.floor_z_m) : null;
    this.surfaces = new SurfacesView(scene.surfaces);
    this.checkpoints = new Checkpoints(scene.checkpoints, scene.floor_z_m);
    this.shapes = add_shapes(scene.shapes, device);
    this.scanner = scanner_zone(scene.box, scene.floor_z_m);
    this.ghost = new Ghost(scene);
    this.gauges = gauges_of(scene, device);
    this.trails.add(this.handle_trail.line, this.elbow_trail.line);
    this.root.add(device.placement, twin.placement, this.surroundings.group, this.ghost.group);
    this.root.add(this.person.group, this.trails, this.scanner, this.surfaces.group);
    this.root.add(this.checkpoints.group);
    if (remote) this.root.add(remote.group);
    if (this.base) this.root.add(this.base.group);
    this.root.add(this.handle.pull, this.handle.arrows);
    stage.ground(this.root);
    this.apply_layers();
    this.see_through.add_links(twin.placement);
    if (this.surroundings.wall) this.see_through.add_whole([this.surroundings.wall]);
    this.see_through.add_whole(this.person.parts);
    if (scene.gantry_joints > 0 && this.shoulder) {
      this.see_through.add_frame(device.placement, this.shoulder);
    }
  }

  static async load(scene: Scene, stage: Stage, layers: Layers): Promise<World> {
    const [device, twin] = await Promise.all([
      load_chain(scene.device, (root) => paint_shapes(root, DEVICE)),
      load_chain(scene.twin, (root) => paint_shapes(root, TWIN)),
    ]);
    const [remote] = await Promise.all([
      Remote.load(scene, arrow_of(scene, device)),
      device.complete,
      twin.complete,
    ]);
    return new World(scene, device, twin, remote, stage, layers);
  }

  apply_layers(): void {
    const parts: [Layer, Object3D[]][] = [
      ["device", [this.device.placement]],
      ["twin", [this.twin.placement]],
      ["remote", this.remote ? [this.remote.group] : []],
      ["ghost", [this.ghost.group]],
      ["surfaces", [this.surfaces.group]],
      ["checkpoints", [this.checkpoints.group]],
      ["base", this.base ? [this.base.group] : []],
      ["surroundings", [this.surroundings.group]],
      ["person", [this.person.group]],
      ["arrows", [this.handle.arrows]],
      ["limits", this.gauges.map((gauge) => gauge.view.limit_ring)],
      ["torques", this.gauges.map((gauge) => gauge.view.torque_ring)],
      ["trails", [this.trails]],
      ["box", [this.stage.box_view]],
      ["shapes", this.shapes],
      ["scanner", [this.scanner]],
    ];
    for (const [layer, objects] of parts) {
      for (const object of objects) object.visible = this.layers.is_shown(layer);
    }
  }

  paint(theme: Theme): void {
    this.surroundings.paint(theme);
    this.base?.paint(theme);
    this.person.paint(theme);
  }

  note(frame: Frame): void {
    const step_s = frame.time_s - this.noted_s;
    this.noted_s = frame.time_s;
    if (step_s < 0 || step_s > MOST_STEP_S) {
      for (const trail of this.both_trails) trail.clear();
      this.base?.forget_way();
    }
    this.base?.note(frame.twin_base);
    this.handle_trail.add(frame.p_B_H_m);
    this.elbow_trail.add(frame.p_B_elbow_m);
  }

  // `target`: where the handle is dragged to, null = it is not; `axis`: along which only;
  // `reached`: number of checkpoints.
  show(frame: Frame, target: Vec3 | null, axis: Vec3 | null, reached: number): void {
    this.pose(frame);
    this.show_gauges(frame);
    this.handle.show_wrench(frame.p_B_H_m, frame.force_N, frame.torque_Nm);
    this.handle.show_target(frame.p_B_H_m, target, axis);
    this.ghost.show(frame.ghost);
    this.remote?.show(frame.teleoperation);
    this.surfaces.show(frame.p_B_E_m, frame.contact);
    this.checkpoints.show(new Vector3(...frame.p_B_H_m), attitude_of(frame), reached);
    const eye = this.stage.camera.getWorldPosition(new Vector3());
    const seen = [frame.p_B_H_m, frame.p_B_E_m, frame.p_B_elbow_m];
    this.see_through.update(eye, seen.map((point) => new Vector3(...point)));
  }

  // What a first view is to show.
  sights(frame: Frame): Sights {
    this.pose(frame);
    const { shoulder } = this;
    const { gantry_joints } = this.scene;
    this.remote?.show(frame.teleoperation);
    const remote = this.remote ? [this.remote.machine_root, this.remote.walls_group] : [];
    const frame_points = shoulder ? points_on(this.device.placement, shoulder) : [];
    const table = gantry_joints === 0 ? thinned(frame_points, TABLE_POINTS) : [];
    return {
      arm: points_on(shoulder ?? this.device.placement),
      frame: frame_points,
      twin: [...points_on(this.twin.placement), ...remote.flatMap((part) => points_on(part))],
      person: this.person.parts.flatMap((part) => points_on(part)),
      around: [this.surroundings.group, this.surfaces.group].flatMap((part) => points_on(part)),
      handle: new Vector3(...frame.p_B_H_m),
      to_user: new Vector3(0, 0, 1).applyQuaternion(attitude_of(frame)),
      arrow: this.arrow.longest_m,
      room: [...ways_of_handle(this.scene, frame, this.twin), ...table],
    };
  }

  dispose(): void {
    this.root.removeFromParent();
    dispose_of(this.root);
  }

  // The first joint that no gantry moves.
  private get shoulder(): Object3D | null {
    const first = this.scene.device.joints[this.scene.gantry_joints];
    return first ? this.device.joint(first.name) : null;
  }

  private pose(frame: Frame): void {
    this.device.pose(frame.q_device);
    this.twin.pose(frame.q_twin, frame.twin_base);
    this.base?.show(frame.twin_base);
    const { group, is_at_twin } = this.surroundings;
    if (is_at_twin) put_at_root(group, this.scene.twin, frame.twin_base);
    this.person.pose(new Vector3(...frame.p_B_H_m), attitude_of(frame));
  }

  private show_gauges(frame: Frame): void {
    for (const { view, coordinate, limit } of this.gauges) {
      const q = frame.q_device[coordinate] ?? 0;
      const torque = frame.tau_measured_Nm[coordinate - this.scene.gantry_joints] ?? 0;
      view.show(q, limit < 0 ? "far" : limit_closeness(this.scene, frame, limit));
      view.show_torque(q, torque);
    }
  }
}

function arrow_of(scene: Scene, device: ChainView): ArrowSize {
  const joints = scene.device.joints.map(({ name }) => device.joint(name));
  return arrow_size(joints.filter((joint) => joint !== null));
}

function attitude_of(frame: Frame): Quaternion {
  return new Quaternion(...frame.quaternion_B_H).normalize();
}

function gauges_of(scene: Scene, device: ChainView): Gauge[] {
  const gauges: Gauge[] = [];
  for (const [coordinate, joint] of scene.device.joints.entries()) {
    const drawn = device.joint(joint.name);
    if (!drawn || joint.type !== "revolute") continue;
    const { q_min, q_max } = joint;
    const range = q_min !== null && q_max !== null ? { min: q_min, max: q_max } : null;
    const limit = scene.limits.findIndex(
      ({ kind, name }) => kind === "manipulator" && name === joint.name,
    );
    gauges.push({ view: new JointGauge(drawn, range, joint.tau_max), coordinate, limit });
  }
  return gauges;
}
