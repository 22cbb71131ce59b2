// The numbers of the last frames, column by column, for plots and export.

import type { Frame, Scene, SceneJoint, Teleoperation } from "../messages";

const HISTORY_FRAMES = 7200; // two minutes at 60 Hz

// A table that forgets its oldest rows; columns are views without a copy.
export class Table {
  private readonly columns: Float64Array[];
  private start = 0;
  private end = 0;
  first_row = 0; // so many have been forgotten

  constructor(
    readonly names: string[],
    private readonly rows = HISTORY_FRAMES,
  ) {
    this.columns = names.map(() => new Float64Array(2 * rows));
  }

  get length(): number {
    return this.end - this.start;
  }

  push(row: (number | null | undefined)[]): void {
    if (this.end === 2 * this.rows) {
      for (const column of this.columns) column.copyWithin(0, this.start, this.end);
      this.end -= this.start;
      this.start = 0;
    }
    for (const [i, column] of this.columns.entries()) column[this.end] = row[i] ?? NaN;
    this.end += 1;
    if (this.length > this.rows) {
      this.start += 1;
      this.first_row += 1;
    }
  }

  column(name: string): Float64Array {
    const index = this.names.indexOf(name);
    if (index < 0) throw new Error(`history has no column ${name}`);
    return this.columns[index]!.subarray(this.start, this.end);
  }

  last(name: string): number {
    return this.column(name).at(-1) ?? NaN;
  }

  clear(): void {
    this.start = this.end = this.first_row = 0;
  }

  csv(): string {
    const columns = this.names.map((name) => this.column(name));
    const lines = [this.names.join(",")];
    for (let i = 0; i < this.length; i++) {
      lines.push(columns.map((column) => number_text(column[i]!)).join(","));
    }
    return lines.join("\n") + "\n";
  }
}

function number_text(value: number): string {
  return Number.isFinite(value) ? String(Number(value.toPrecision(9))) : "";
}

// Coordinates of a chain with their names; a floating joint has seven.
export function coordinates_of(joints: SceneJoint[]): string[] {
  return joints.flatMap((joint) =>
    joint.type === "floating"
      ? ["x", "y", "z", "qx", "qy", "qz", "qw"].map((part) => `${joint.name}.${part}`)
      : [joint.name],
  );
}

const AXES = ["x", "y", "z"];

// Sizes, at the scale of the remote machine.
const REMOTE_COLUMNS = [
  "remote.force_leader",
  "remote.force_remote",
  "remote.energy_leader_J",
  "remote.energy_remote_J",
  "remote.dissipated_J",
  "remote.apart",
  "remote.age_s",
];

function remote_row(remote: Frame["teleoperation"]): (number | null)[] {
  if (!remote) return REMOTE_COLUMNS.map(() => null);
  return [
    Math.hypot(...remote.f_leader),
    Math.hypot(...remote.f_remote),
    remote.energy_leader,
    remote.energy_remote,
    remote.dissipated,
    apart(remote),
    remote.age_s,
  ];
}

const BASE_COLUMNS = AXES.flatMap((a) => [`base_${a}_m`, `base_v_${a}_m_per_s`]);

function base_row(base: Frame["twin_base"]): (number | null)[] {
  return AXES.flatMap((_, i) => [base?.p_B_m[i] ?? null, base?.v_m_per_s[i] ?? null]);
}

// How far a remote machine is from where it is to be, m or rad; null: it is not led.
export function apart({ link, x_target, x_remote }: Teleoperation): number | null {
  const is_known = link === "engaged" && x_target.length > 0 && x_target.length === x_remote.length;
  return is_known ? Math.hypot(...x_target.map((x, i) => x - x_remote[i]!)) : null;
}

// Joints of device and twin may have the same name.
export function limit_column({ kind, name }: Scene["limits"][number]): string {
  return `active.${kind}.${name}`;
}

export function history_of(scene: Scene): Table {
  const manipulator = scene.device.joints.slice(scene.gantry_joints);
  return new Table([
    "time_s",
    "force_N",
    ...AXES.map((a) => `force_${a}_N`),
    "torque_Nm",
    ...AXES.map((a) => `torque_${a}_Nm`),
    ...coordinates_of(scene.device.joints).map((name) => `device.${name}`),
    ...coordinates_of(scene.twin.joints).map((name) => `twin.${name}`),
    ...manipulator.map((joint) => `torque.${joint.name}_Nm`),
    ...AXES.map((a) => `handle_${a}_m`),
    ...AXES.map((a) => `elbow_${a}_m`),
    "cycle_time_us",
    "cycle_time_max_us",
    ...scene.limits.map(limit_column),
    ...(scene.teleoperation ? REMOTE_COLUMNS : []),
    ...(scene.twin_base_moves ? BASE_COLUMNS : []),
  ]);
}

const STATES = { inactive: 0, lower: -1, upper: 1, violated: 2 };

export function row_of(scene: Scene, frame: Frame): (number | null | undefined)[] {
  const states = new Float64Array(scene.limits.length);
  for (const limit of frame.active) states[limit.index] = STATES[limit.state] ?? 0;
  const device = coordinates_of(scene.device.joints).map((_, i) => frame.q_device[i]);
  const twin = coordinates_of(scene.twin.joints).map((_, i) => frame.q_twin[i]);
  const manipulator = scene.device.joints.slice(scene.gantry_joints);
  return [
    frame.time_s,
    Math.hypot(...frame.force_N),
    ...frame.force_N,
    Math.hypot(...frame.torque_Nm),
    ...frame.torque_Nm,
    ...device,
    ...twin,
    ...manipulator.map((_, i) => frame.tau_measured_Nm[i]),
    ...frame.p_B_H_m,
    ...frame.p_B_elbow_m,
    frame.cycle_time_us,
    frame.cycle_time_max_us,
    ...states,
    ...(scene.teleoperation ? remote_row(frame.teleoperation) : []),
    ...(scene.twin_base_moves ? base_row(frame.twin_base) : []),
  ];
}
