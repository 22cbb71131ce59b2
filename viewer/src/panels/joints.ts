// All joints of device and twin: where they are in their range, and how hard they work.

import { coordinates_of } from "../data/history";
import { limit_closeness } from "../limit_words";
import type { Frame, Scene, SceneJoint } from "../messages";
import { fill, make, write } from "../page";
import { effort_text, joint_text, share_between } from "../text";

interface Row {
  joint: SceneJoint;
  coordinate: number;
  limit: number; // in Scene.limits, -1 = none
  row: HTMLElement;
  value: HTMLElement;
  mark: HTMLElement;
  torque: HTMLElement | null;
}

export class JointsPanel {
  private device: Row[] = [];
  private twin: Row[] = [];
  private readonly body = make("div");

  constructor(section: HTMLElement) {
    section.append(this.body);
  }

  load(scene: Scene): void {
    this.device = rows_of(scene, scene.device.joints, "manipulator");
    this.twin = rows_of(scene, scene.twin.joints, "twin");
    this.body.replaceChildren(make("h2", "", "Twin"));
    this.body.append(...this.twin.map(({ row }) => row));
    if (this.twin.length === 0) this.body.append(make("p", "quiet", "a body that moves freely"));
    this.body.append(make("h2", "", "Device"), ...this.device.map(({ row }) => row));
    this.body.append(make("p", "quiet", "Mark: place in the range. Violet: share of the largest torque."));
  }

  show(scene: Scene, frame: Frame): void {
    for (const row of this.twin) this.show_row(row, scene, frame, frame.q_twin);
    for (const row of this.device) {
      this.show_row(row, scene, frame, frame.q_device);
      const torque = frame.tau_measured_Nm[row.coordinate - scene.gantry_joints];
      if (row.torque) show_torque(row.torque, row.joint, torque ?? NaN);
    }
  }

  private show_row(row: Row, scene: Scene, frame: Frame, q: number[]): void {
    const value = q[row.coordinate] ?? NaN;
    write(row.value, joint_text(value, row.joint));
    const share = share_between(value, row.joint.q_min, row.joint.q_max);
    row.mark.hidden = share === null;
    if (share !== null) row.mark.style.left = `${(100 * share).toFixed(1)}%`;
    row.row.dataset.state = row.limit < 0 ? "far" : limit_closeness(scene, frame, row.limit);
  }
}

function show_torque(bar: HTMLElement, joint: SceneJoint, torque: number): void {
  fill(bar, Number.isFinite(torque) ? Math.abs(torque) / (joint.tau_max ?? Infinity) : 0);
  bar.title = effort_text(torque, joint);
}

function rows_of(scene: Scene, joints: SceneJoint[], kind: "manipulator" | "twin"): Row[] {
  const names = coordinates_of(joints);
  return joints.flatMap((joint) => {
    if (joint.type === "floating") return [];
    const coordinate = names.indexOf(joint.name);
    const limit = scene.limits.findIndex((l) => l.kind === kind && l.name === joint.name);
    const value = make("output");
    const mark = make("i");
    const torque =
      kind === "manipulator" && joint.tau_max !== null
        ? make("div", "bar torque", make("i"))
        : null;
    const range = make("div", "range", mark);
    range.title = range_text(joint);
    const row = make("div", "joint", make("span", "", joint.name), value, range);
    if (torque) row.append(torque);
    return [{ joint, coordinate, limit, row, value, mark, torque }];
  });
}

function range_text(joint: SceneJoint): string {
  const end = (q: number | null): string => (q === null ? "no end" : joint_text(q, joint));
  return `${end(joint.q_min)} to ${end(joint.q_max)}`;
}
