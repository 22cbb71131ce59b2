// Which time plots there are for a scene. Pure functions.

import { coordinates_of } from "../data/history";
import type { Scene, SceneJoint } from "../messages";

export interface Series {
  label: string;
  column: string; // of the history
  scale: number; // history's unit to the plot's
  is_main?: boolean; // drawn thicker
}

export interface PlotLimit {
  series: number; // that it belongs to
  value: number; // in the plot's unit
}

export interface TimeSpec {
  id: string;
  title: string;
  unit: string;
  series: Series[];
  limits: PlotLimit[];
  smallest_span: number; // of the vertical axis
}

const DEGREES = 180 / Math.PI;

export function time_specs(scene: Scene): TimeSpec[] {
  const gantry = scene.device.joints.slice(0, scene.gantry_joints);
  const manipulator = scene.device.joints.slice(scene.gantry_joints);
  const specs = [
    wrench("force", "Force", "N", 4),
    wrench("torque", "Torque", "Nm", 1),
    ...joints("twin", "Twin joints", "twin", scene.twin.joints),
    twin_position(scene.twin.joints),
    ...joints("device", "Device joints", "device", manipulator),
    ...joints("gantry", "Gantry", "device", gantry),
    torques(manipulator),
    ...remote(scene),
    ...base(scene),
  ];
  return specs.filter(({ series }) => series.length > 0);
}

function wrench(id: string, title: string, unit: string, smallest_span: number): TimeSpec {
  const part = (axis: string): Series => ({
    label: axis,
    column: `${id}_${axis}_${unit}`,
    scale: 1,
  });
  const whole = { label: "size", column: `${id}_${unit}`, scale: 1, is_main: true };
  return {
    id,
    title,
    unit,
    series: [whole, part("x"), part("y"), part("z")],
    limits: [],
    smallest_span,
  };
}

function twin_position(all: SceneJoint[]): TimeSpec {
  const free = all.filter(({ type }) => type === "floating");
  return {
    id: "twin-position",
    title: "Twin position",
    unit: "m",
    series: free.flatMap((joint) =>
      coordinates_of([joint])
        .slice(0, 3)
        .map((name) => ({ label: name.split(".").at(-1)!, column: `twin.${name}`, scale: 1 })),
    ),
    limits: [],
    smallest_span: 0.1,
  };
}

// Those that turn and those that slide have a plot each.
function joints(id: string, title: string, chain: string, all: SceneJoint[]): TimeSpec[] {
  const part = (type: SceneJoint["type"], more: Omit<Part, "joints">): TimeSpec =>
    joints_of_one_kind(chain, { ...more, joints: all.filter((joint) => joint.type === type) });
  return [
    part("revolute", { id, title, unit: "\u00b0", scale: DEGREES, smallest_span: 5 }),
    part("prismatic", {
      id: `${id}-slides`,
      title: `${title}, slides`,
      unit: "m",
      scale: 1,
      smallest_span: 0.05,
    }),
  ];
}

interface Part {
  id: string;
  title: string;
  unit: string;
  scale: number;
  smallest_span: number;
  joints: SceneJoint[];
}

function joints_of_one_kind(chain: string, { joints: all, scale, ...part }: Part): TimeSpec {
  const limits = all.flatMap(({ q_min, q_max }, series) =>
    [q_min, q_max].flatMap((q) => (q === null ? [] : [{ series, value: q * scale }])),
  );
  const series = all.map(({ name }) => ({ label: name, column: `${chain}.${name}`, scale }));
  return { ...part, series, limits };
}

function torques(manipulator: SceneJoint[]): TimeSpec {
  return {
    id: "joint-torques",
    title: "Joint torques",
    unit: "Nm",
    series: manipulator.map(({ name }) => ({
      label: name,
      column: `torque.${name}_Nm`,
      scale: 1,
    })),
    limits: [],
    smallest_span: 10,
  };
}

// Of a teleoperation: what its two ends feel, and how energy went.
function remote({ teleoperation }: Scene): TimeSpec[] {
  if (!teleoperation) return [];
  const unit = teleoperation.mapping === "tool" ? "N" : "Nm";
  const part = (label: string, column: string): Series => ({ label, column: `remote.${column}`, scale: 1 });
  return [
    {
      id: "remote-energy",
      title: "Energy of both ports",
      unit: "J",
      series: [
        { ...part("operator's port", "energy_leader_J"), is_main: true },
        { ...part("remote port", "energy_remote_J"), is_main: true },
        part("dissipated", "dissipated_J"),
      ],
      limits: [],
      smallest_span: 0.2,
    },
    {
      id: "remote-force",
      title: "Force at both ends",
      unit,
      series: [part("on your hand", "force_leader"), part("on the remote machine", "force_remote")],
      limits: [],
      smallest_span: 4,
    },
  ];
}

// Velocity of what carries the twin: its position is mostly far from zero.
function base({ twin_base_moves }: Scene): TimeSpec[] {
  if (!twin_base_moves) return [];
  return [
    {
      id: "twin-base",
      title: "Base of the twin",
      unit: "cm/s",
      series: ["x", "y", "z"].map((axis) => ({ label: axis, column: `base_v_${axis}_m_per_s`, scale: 100 })),
      limits: [],
      smallest_span: 4,
    },
  ];
}

// First index whose time is not before `time`; times rise.
export function index_at(times: Float64Array, time: number): number {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle]! < time) low = middle + 1;
    else high = middle;
  }
  return low;
}
