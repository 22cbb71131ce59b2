// The messages between program and page. The C++ side (hg/viewer_server/messages.h) is tested
// against the field names in this file. Units are part of the names; B is the base frame (z up).

export type Vec3 = [number, number, number];

// GET /scene.json: fixed during a run
export interface Scene {
  title: string;
  rate_hz: number;
  update_rate_hz: number;
  device: SceneChain;
  twin: SceneChain;
  limits: SceneLimit[];
  floor_z_m: number;
  box: SceneBox;
}

export interface SceneChain {
  urdf: string; // address of the file, empty = none
  p_B_root_m: Vec3;
  quaternion_B_root: number[]; // x y z w
  joints: SceneJoint[]; // in the order of the coordinates
}

export interface SceneJoint {
  name: string;
  type: "revolute" | "prismatic" | "floating"; // floating: x y z qx qy qz qw
  planar: string; // joint of the URDF that this is one of three parts of: slide, slide, turn
  axis: Vec3; // of such a part, in the frame of the planar joint
}

export interface SceneLimit {
  name: string;
  kind: "manipulator" | "virtual" | "cartesian" | "twin";
  unit: "rad" | "m";
  min: number | null; // null = unbounded
  max: number | null;
}

export interface SceneBox {
  min_m: Vec3;
  max_m: Vec3;
}

// program -> page. A number that is not finite arrives as null.
export interface Frame {
  type: "frame";
  time_s: number;
  mode: string;
  fault: string; // empty = none
  status: string; // one line from the program
  q_device: number[]; // rad or m: gantry, then reference of the manipulator
  q_twin: number[]; // rad or m
  p_B_H_m: Vec3; // handle
  force_N: Vec3; // of the user on the handle, in B
  torque_Nm: Vec3;
  felt: FeltLimit | null;
  sync_error_mm: number;
  sync_error_deg: number;
  cycle_time_us: number;
  hand: Hand;
}

export interface FeltLimit {
  index: number; // in Scene.limits
  name: string;
  text: string; // "elbow x: upper limit, 23 N"
}

export interface Event {
  type: "event";
  time_s: number;
  name: string;
  text: string;
}

// page -> program (type "hand"), and what the program made of it (inside a frame)
export interface Hand {
  type: "hand";
  active: boolean;
  p_B_m: Vec3;
  press: number; // 0..1
}
