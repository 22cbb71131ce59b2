// Generated from the lists of fields in hg/viewer_server/ and hg/signals/; do not edit. Units
// stand in the names or in the comments; B is the base frame (z up), H the handle. A number
// that is not finite arrives as null.

export type Vec3 = [number, number, number];
export type Quaternion = [number, number, number, number]; // x y z w

// GET /scene.json: fixed in a run
export interface Scene {
  run: number; // number of the run; fetch the scene again once a Frame has another one
  source: "run" | "recording";
  title: string;
  description: string;
  rate_hz: number; // rate of the control cycle
  update_rate_hz: number; // rate of frames
  begin_s: number; // begin of a recording, in the time of its run
  duration_s: number; // duration of a recording, or planned; 0 = open
  device: SceneChain;
  twin: SceneChain;
  twin_base_moves: boolean; // its root link moves, as Frame.twin_base says
  gantry_joints: number; // number of gantry joints, the first ones of the device
  limits: SceneLimit[];
  floor_z_m: number;
  box: SceneBox;
  environment: "room" | "door" | "excavator"; // surroundings of the twin
  surfaces: SceneSurface[];
  shapes: SceneShape[]; // shapes of the device, watched for collisions with itself
  checkpoints: SceneCheckpoint[]; // places that the handle is to be brought to, in order
  teleoperation: SceneTeleoperation | null; // null = there is no remote machine
  choices: Choices;
  settings: Setting[];
  commands: ("pause" | "resume" | "step" | "speed" | "restart" | "stop" | "scenario" | "twin" | "device" | "surfaces" | "law" | "person" | "set" | "seek" | "panel" | "mode" | "emergency_stop" | "mark" | "release_stop" | "ask_for_hand" | "clutch")[]; // accepted commands
  refusal: string; // reason for refusing other commands; empty = all are accepted
  hand_stiffness_N_per_m: Vec3; // of the arm that pulls the hand to its target, along x, y, z of B
  hand_force_max_N: number; // largest pull of this arm
  stopping: string; // duration and distance of a stop; empty = unknown
}

// a robot or a twin
export interface SceneChain {
  name: string; // name for people
  urdf: string; // address of the file, empty = none
  p_B_root_m: Vec3;
  quaternion_B_root: Quaternion;
  joints: SceneJoint[]; // joints in the order of the coordinates
  followers: SceneFollower[]; // joints that follow by curves, which have no coordinates
}

// a joint of a chain
export interface SceneJoint {
  name: string; // name in the URDF
  type: "revolute" | "prismatic" | "floating"; // floating: x y z qx qy qz qw
  planar: string; // planar joint of the URDF with this joint as one of three parts: slide, slide, turn
  axis: Vec3; // axis of such a part, in the frame of the planar joint
  q_min: number | null; // [rad or m] lower limit; null = unbounded
  q_max: number | null; // [rad or m] upper limit; null = unbounded
  dq_max: number | null; // [rad/s or m/s] speed limit; null = unbounded
  tau_max: number | null; // [Nm or N] peak torque or force; null = unknown
}

// a joint that follows another one by a curve: its position over the other's
export interface SceneFollower {
  joint: string;
  leader: string;
  begin: number; // [rad or m] begin of the range of the leader
  end: number; // [rad or m] end of the range of the leader
  is_periodic: boolean; // the range is one turn, and repeats
  values: number[]; // [rad or m] positions at equal distances over the range
}

// a limited quantity
export interface SceneLimit {
  name: string;
  kind: "manipulator" | "virtual" | "motor" | "cartesian" | "twin" | "self_collision";
  unit: "rad" | "m"; // unit of the position; the reaction has that of a torque or of a force
  min: number | null; // [rad or m] lower end; null = unbounded
  max: number | null; // [rad or m] upper end; null = unbounded
  priority: number; // level of the law: 1 is the coupling of hand and twin, then 2, 3, ...
}

// Cartesian limits of the handle in B
export interface SceneBox {
  min_m: Vec3;
  max_m: Vec3;
}

// a virtual surface
export interface SceneSurface {
  name: string;
  shape: "plane" | "box" | "sphere" | "cylinder" | "mesh"; // a plane is solid below its z = 0, a cylinder has its axis along z
  p_B_m: Vec3; // position of the centre
  quaternion_B: Quaternion;
  size_m: Vec3; // size of the bounding box; zero for a plane
  triangles_m: number[]; // triangles of a mesh, 9 coordinates each; else empty
}

// a shape by which collisions of the device with itself are foreseen
export interface SceneShape {
  name: string;
  link: string; // link of the device's URDF that it moves with
  p_link_m: Vec3; // position of the centre
  quaternion_link: Quaternion;
  radius_m: number; // radius of a capsule along z
  length_m: number; // length of a capsule, without its ends
  size_m: Vec3; // size of a box; zero for a capsule
}

// a place of the handle that an event asks for, nearer than 0.10 m, 15 degrees
export interface SceneCheckpoint {
  name: string; // name of the event
  x_m: number; // position in B
  y_m: number; // position in B
  azimuth_rad: number; // azimuth of the hand axis, z of H, about z of B
}

// the remote machine of a teleoperation
export interface SceneTeleoperation {
  mapping: "tool" | "joints"; // what is led: its tool, or its joints, which are the twin's
  method: string; // method of bilateral control
  link: string; // what is simulated of the link, in words; empty = nothing
  force_scale: number; // force on the leader over that on the machine
  p_B_root_m: Vec3; // where its base is drawn
  quaternion_B_root: Quaternion;
  axes: SceneAxis[];
  walls: SceneWall[];
}

// a coordinate of a remote machine
export interface SceneAxis {
  name: string; // x, y, z, or a joint of the twin
  min: number | null; // [rad or m] null = unbounded
  max: number | null; // [rad or m] null = unbounded
}

// a wall before a remote machine
export interface SceneWall {
  normal: number[]; // unit vector out of the wall, in coordinates of the machine
  offset: number; // [rad or m] position of its surface along the normal
}

// options and the chosen ones
export interface Choices {
  scenario: string; // name of the chosen scenario
  scenarios: Choice[];
  twin: string; // name of the chosen twin; empty: that of the scenario
  twins: Choice[];
  device: string; // name of the chosen device; empty: that of the scenario
  devices: Choice[];
  surfaces: string; // scenario whose virtual surfaces are met, none; empty: those of the scenario
  surface_sets: Choice[];
  law: string;
  laws: Choice[];
  person: string; // person at the handle: a script, mouse, none; empty: that of the scenario
  people: Choice[];
}

// one option
export interface Choice {
  name: string; // name in a command
  title: string; // name for people
  group: string; // heading that it stands below; empty: none
}

// a form field: a value of the twin
export interface Setting {
  name: string; // name in the command "set"
  group: string; // joint of the twin, or empty
  label: string;
  unit: string; // unit of all numbers of the setting
  min: number; // smallest accepted value
  max: number; // largest accepted value
  value: number | null; // initial value, later ones come as Values; null = unlimited
  step: number; // step of the form
  help: string;
}

// program -> page, at update_rate
export interface Frame {
  type: "frame";
  run: number; // number of the run, as Scene.run
  time_s: number;
  mode: "off" | "ready" | "armed" | "running" | "stopping" | "fault";
  mode_text: string; // mode and its cause as text
  fault: string; // empty = none
  status: string; // status in one line
  q_device: number[]; // [rad or m] gantry, then reference of the manipulator
  q_measured: number[]; // [rad or m] gantry, then manipulator
  dq_device: number[]; // [rad/s or m/s] velocities of q_device
  dq_measured: number[]; // [rad/s or m/s] velocities of q_measured
  tau_measured_Nm: number[]; // torque sensors of the joints; empty = none
  q_twin: number[]; // [rad or m] coordinates of the twin
  dq_twin: number[]; // [rad/s or m/s] velocities of the twin; a floating joint has 6, in its own frame
  twin_base: TwinBase | null; // null = its root link rests
  q_gantry_target_m: number[]; // gantry target of prepositioning
  tracking_error: number[]; // [rad or m] reference minus link side of the manipulator
  is_clamped: boolean; // tracking was lost: the reference was moved back
  p_B_H_m: Vec3; // position of the handle, at the reference
  quaternion_B_H: Quaternion;
  v_H_m_per_s: Vec3;
  p_B_E_m: Vec3; // position of the twin's end effector
  quaternion_B_E: Quaternion;
  p_B_elbow_m: Vec3;
  force_N: Vec3; // force of the user on the handle, in B
  torque_Nm: Vec3;
  felt: FeltLimit | null;
  active: ActiveLimit[]; // active limits
  contact: Contact | null; // null = none
  limit_position: number[]; // [rad or m] positions of the limited quantities in the order of Scene.limits
  limit_distance: (number | null)[]; // [rad or m] distance to the nearer end, with margin; null = unbounded
  budget: Budget; // breakdown of the user's wrench
  singularity: Singularity | null;
  sync_error_mm: number; // distance of handle and twin
  sync_error_deg: number;
  cycle_time_us: number;
  cycle_time_max_us: number; // maximum since the last frame
  latency: string; // delays of link, drives, sensor and page in words; empty = unknown
  hand: Hand;
  hand_page: number; // page whose hand holds the handle; 0 = none
  hand_asked_by: number; // page that asks it for the hand; 0 = none
  run_state: RunState;
  safety: Safety;
  clients: number; // number of connected pages
  ghost: Ghost | null;
  teleoperation: Teleoperation | null; // null = there is no remote machine
}

// limit that the user feels most; no wrench for limits of the twin
export interface FeltLimit {
  index: number; // index in Scene.limits
  name: string;
  text: string; // name and side of the limit, and its force
  force_N: Vec3;
  torque_Nm: Vec3;
}

// active limit
export interface ActiveLimit {
  index: number; // index in Scene.limits
  state: "inactive" | "lower" | "upper" | "violated";
  cause: "none" | "position" | "velocity" | "acceleration" | "lock" | "latch" | "friction" | "contradiction" | "torque" | "torque_rate" | "weight" | "braking";
  excess: number; // [rad or m] distance outside the configured range, >= 0
  reaction: number; // [Nm or N] constraint force or torque in the quantity's own coordinate
  text: string;
}

// contact with virtual surfaces
export interface Contact {
  force: Vec3; // [N] force of virtual surfaces on the handle
  proxy: Vec3; // [m] point nearest to the handle outside all surfaces
  surface: number; // surface with the largest force, index in the scenario; -1 = none
}

// user = inertia + damping + ... + structure + rest
export interface Budget {
  user: Wrench; // wrench of the user, the sum of all other parts
  inertia: Wrench; // motion and weight of the twin
  damping: Wrench; // dampers
  spring: Wrench; // springs and closers
  friction: Wrench; // friction while slipping; held joints are limits
  surface: Wrench; // virtual surfaces and the reference wrench of the twin
  limits: Wrench; // active limits
  conflict: Wrench; // limits that could not be met
  structure: Wrench; // bearings of the twin
  rest: Wrench; // unexplained remainder; 0 while running
}

// wrench on the hand, at H, in B
export interface Wrench {
  force_N: Vec3;
  torque_Nm: Vec3;
}

// distance of the manipulator from a singularity
export interface Singularity {
  measure: number; // 0 = singular, 1 = largest distance from it for this device
  limit: number; // index in Scene.limits of the limit that keeps it away; -1 = none
}

// state of the run as set by commands
export interface RunState {
  is_paused: boolean;
  speed: number; // simulated or recorded time over real time
  is_over: boolean; // stopped, a fault, or the end of a recording
  position_s: number; // time of the run, also of a recorded one
  recording: string; // name of the file that is written or played; empty = none
}

// cause of a stop, and the panel of the simulated operator
export interface Safety {
  stop: "none" | "SS2" | "SS1" | "STO"; // kind of the present or last stop
  is_autonomous: boolean; // runs autonomously, with a free handle
  fault: number; // number of the cause; 0 = none
  cause: string; // cause with value and limit; empty = none
  release: string; // conditions for a reset
  warning: string; // rule nearest to its threshold; empty = all are far from it
  emergency_stop: boolean; // an emergency stop is pressed
  stop_pressed_by: number[]; // pages that pressed it, perhaps gone; 0 = script
  operator_enable: boolean; // enabling switch is held
  override_key: boolean; // override key is turned
  person_in_field: boolean; // a person besides the user is in the scanner's field
}

// pose, velocity and acceleration of the twin's root link in B
export interface TwinBase {
  p_B_m: Vec3;
  quaternion_B: Quaternion;
  v_m_per_s: Vec3;
  omega: Vec3; // [rad/s]
  a: Vec3; // [m/s^2] of its origin
}

// second recording, overlaid for comparison
export interface Ghost {
  time_s: number; // time of its run
  q_device: number[]; // [rad or m] gantry, then reference of the manipulator
  q_twin: number[]; // [rad or m] coordinates of the twin
  twin_base: TwinBase | null; // null = its root link rests
  p_B_H_m: Vec3;
  force_N: Vec3;
}

// the other side, in coordinates of the remote machine
export interface Teleoperation {
  link: "none" | "waiting" | "released" | "engaged" | "lost";
  cause: "none" | "speed" | "acceleration" | "range" | "force" | "not_finite" | "jump" | "replayed" | "frozen" | "silent" | "released" | "stopped" | "active"; // why the remote machine does not follow, as it last said
  is_clutch_open: boolean; // a page has opened the clutch
  age_s: number; // time since the newest packet from the remote machine was sent
  round_trip_s: number; // of packets, there and back
  jitter_s: number; // mean difference of the delays of two packets in a row
  loss: number; // share of packets from the remote machine that were lost
  x_target: number[]; // [rad or m] where the leader wants the remote machine
  x_remote: number[]; // [rad or m] where it last said it was
  f_leader: number[]; // [Nm or N] force on the leader, at the scale of the remote machine
  f_remote: number[]; // [Nm or N] force of its surroundings on the remote machine
  energy_leader: number; // [J] net energy taken at the operator's port
  energy_remote: number; // [J] net energy taken at the remote port
  dissipated: number; // [J] energy dissipated by the method at both ports
}

// page -> program; inside a frame: the target in effect
export interface Hand {
  type: "hand";
  active: boolean;
  p_B_m: Vec3;
  quaternion_B_H: Quaternion | null; // target orientation of the handle; null = the handle may rotate freely
  press: number; // how far the hand presses its lever, 0..1
}

// page -> program, every 30 ms: the page is alive and keeps its hold
export interface Hold {
  type: "hold";
  sequence: number; // rising number; repeated and older ones are ignored
}

// page -> program
export interface Command {
  type: "command";
  id: number; // any whole number of 0..2^53, comes back in the answer
  command: "pause" | "resume" | "step" | "speed" | "restart" | "stop" | "scenario" | "twin" | "device" | "surfaces" | "law" | "person" | "set" | "seek" | "panel" | "mode" | "emergency_stop" | "mark" | "release_stop" | "ask_for_hand" | "clutch";
  name: string; // name of the chosen option or setting; else empty
  value: number; // step: cycles, speed: 0.1..1 (recordings ..8), seek: run time, set: value, release_stop: page, clutch: 1 open, 0 closed
}

// program -> page: the first message of a connection
export interface Welcome {
  type: "welcome";
  page: number; // number of this connection
}

// program -> page: one per Command, and per refused message
export interface Answer {
  type: "answer";
  id: number; // id of the command; -1 = the message could not be read
  is_accepted: boolean; // mode: followed by the cycle; set, panel: passed on
  reason: string; // reason of the refusal; empty = accepted
}

// program -> page: at the connection and after each change
export interface Values {
  type: "values";
  values: (number | null)[]; // values in the order of Scene.settings; null = unlimited
}

// program -> page
export interface Event {
  type: "event";
  run: number; // number of the run, as Scene.run
  time_s: number;
  name: string;
  text: string;
}
