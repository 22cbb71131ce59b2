// A small scene and a frame of it, for tests.

import type { Budget, Frame, Scene, SceneJoint, Wrench } from "../../src/messages";

export function joint(name: string, more: Partial<SceneJoint> = {}): SceneJoint {
  return {
    name,
    type: "revolute",
    planar: "",
    axis: [1, 0, 0],
    q_min: null,
    q_max: null,
    dq_max: null,
    tau_max: null,
    ...more,
  };
}

export const scene: Scene = {
  run: 3,
  source: "run",
  title: "Door",
  description: "",
  rate_hz: 1000,
  update_rate_hz: 60,
  begin_s: 0,
  duration_s: 0,
  device: {
    name: "HapticGiant",
    urdf: "",
    p_B_root_m: [0, 0, 0],
    quaternion_B_root: [0, 0, 0, 1],
    joints: [
      joint("ppu1", { type: "prismatic", q_min: -1, q_max: 1 }),
      joint("m1"),
      joint("m2", { q_min: 0, q_max: 2, tau_max: 100 }),
    ],
    followers: [],
  },
  twin: {
    name: "door",
    urdf: "",
    p_B_root_m: [0, 0, 0],
    quaternion_B_root: [0, 0, 0, 1],
    joints: [joint("hinge", { q_min: 0, q_max: 1.5 })],
    followers: [],
  },
  gantry_joints: 1,
  limits: [
    { name: "m2", kind: "manipulator", unit: "rad", min: 0, max: 2, priority: 2 },
    { name: "hand x", kind: "cartesian", unit: "m", min: -1, max: 1, priority: 3 },
    { name: "hinge", kind: "twin", unit: "rad", min: 0, max: 1.5, priority: 4 },
  ],
  floor_z_m: -2,
  box: { min_m: [-1, -1, -1], max_m: [1, 1, 0] },
  environment: "door",
  surfaces: [],
  shapes: [],
  choices: {
    scenario: "door",
    scenarios: [],
    twin: "",
    twins: [],
    law: "gauss",
    laws: [],
    person: "",
    people: [],
  },
  settings: [],
  commands: [],
  refusal: "",
  stopping: "",
};

export function wrench(force_N: Wrench["force_N"] = [0, 0, 0]): Wrench {
  return { force_N, torque_Nm: [0, 0, 0] };
}

export function budget(parts: Partial<Budget> = {}): Budget {
  return {
    user: wrench(),
    inertia: wrench(),
    damping: wrench(),
    spring: wrench(),
    friction: wrench(),
    surface: wrench(),
    limits: wrench(),
    conflict: wrench(),
    structure: wrench(),
    rest: wrench(),
    ...parts,
  };
}

export const frame: Frame = {
  type: "frame",
  run: 3,
  time_s: 1.5,
  mode: "running",
  mode_text: "running",
  fault: "",
  status: "",
  q_device: [0.1, 0.2, 0.3],
  q_measured: [0.1, 0.2, 0.3],
  dq_device: [0, 0, 0],
  dq_measured: [0, 0, 0],
  tau_measured_Nm: [5, 6],
  q_twin: [0.4],
  dq_twin: [0],
  q_gantry_target_m: [0],
  tracking_error: [0, 0],
  is_clamped: false,
  p_B_H_m: [1, 2, 3],
  quaternion_B_H: [0, 0, 0, 1],
  v_H_m_per_s: [0, 0, 0],
  p_B_E_m: [1, 2, 3],
  quaternion_B_E: [0, 0, 0, 1],
  p_B_elbow_m: [4, 5, 6],
  force_N: [0, 3, 4],
  torque_Nm: [0, 0, 2],
  felt: null,
  active: [],
  contact: null,
  limit_position: [0.3, 0.5, 0.4],
  limit_distance: [0.3, 0.5, 0.4],
  budget: budget(),
  singularity: { measure: 0.5, limit: -1 },
  sync_error_mm: 0,
  sync_error_deg: 0,
  cycle_time_us: 20,
  cycle_time_max_us: 30,
  hand: { type: "hand", active: false, p_B_m: [0, 0, 0], quaternion_B_H: null, press: 0 },
  run_state: { is_paused: false, speed: 1, is_over: false, position_s: 1.5, recording: "" },
  safety: {
    stop: "none",
    is_autonomous: false,
    fault: 0,
    cause: "",
    release: "",
    warning: "",
    emergency_stop: false,
    stop_pressed_by: [],
    operator_enable: true,
    override_key: false,
    person_in_field: false,
  },
  clients: 1,
  ghost: null,
};
