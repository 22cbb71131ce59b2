// Reads what comes over the socket. Nothing that is not as messages.ts says reaches the views.

import type { Answer, Event, Frame, Values, Welcome } from "../messages";

export type Message = Welcome | Frame | Event | Answer | Values;

type Test = (value: unknown) => boolean;

const is_number: Test = (value) => typeof value === "number" && Number.isFinite(value);
const is_text: Test = (value) => typeof value === "string";
const is_flag: Test = (value) => typeof value === "boolean";
const is_object: Test = (value) => typeof value === "object" && value !== null;
const or_null = (test: Test): Test => (value) => value === null || test(value);
const list_of = (test: Test): Test => (value) => Array.isArray(value) && value.every(test);
const vector = (length: number): Test => (value) =>
  Array.isArray(value) && value.length === length && value.every(is_number);
const is_any: Test = (value) => value !== undefined;

const FRAME: Record<keyof Omit<Frame, "type">, Test> = {
  run: is_number,
  time_s: is_number,
  mode: is_text,
  mode_text: is_text,
  fault: is_text,
  status: is_text,
  q_device: list_of(is_number),
  q_measured: list_of(or_null(is_number)),
  dq_device: is_any,
  dq_measured: is_any,
  tau_measured_Nm: list_of(or_null(is_number)),
  q_twin: list_of(is_number),
  dq_twin: is_any,
  twin_base: or_null(is_object),
  q_gantry_target_m: is_any,
  tracking_error: is_any,
  is_clamped: is_flag,
  p_B_H_m: vector(3),
  quaternion_B_H: vector(4),
  v_H_m_per_s: is_any,
  p_B_E_m: is_any,
  quaternion_B_E: is_any,
  p_B_elbow_m: vector(3),
  force_N: vector(3),
  torque_Nm: vector(3),
  felt: or_null(is_object),
  active: list_of(is_object),
  contact: or_null(is_object),
  limit_position: list_of(or_null(is_number)),
  limit_distance: list_of(or_null(is_number)),
  budget: is_object,
  singularity: or_null(is_object),
  sync_error_mm: or_null(is_number),
  sync_error_deg: or_null(is_number),
  cycle_time_us: or_null(is_number),
  cycle_time_max_us: or_null(is_number),
  latency: is_text,
  hand: is_object,
  hand_page: is_number,
  hand_asked_by: is_number,
  run_state: is_object,
  safety: is_object,
  clients: is_number,
  ghost: or_null(is_object),
  teleoperation: or_null(is_object),
};

const FIELDS: Record<Message["type"], Record<string, Test>> = {
  welcome: { page: is_number },
  frame: FRAME,
  event: { run: is_number, time_s: is_number, name: is_text, text: is_text },
  answer: { id: is_number, is_accepted: is_flag, reason: is_text },
  values: { values: list_of(or_null(is_number)) },
};

// The message in `text`, or why there is none.
export function read_message(text: unknown): Message | string {
  let message: Record<string, unknown>;
  try {
    message = JSON.parse(String(text));
  } catch {
    return "not JSON";
  }
  if (!is_object(message)) return "not an object";
  const fields = FIELDS[message.type as Message["type"]];
  if (!Object.hasOwn(FIELDS, String(message.type)) || !fields) {
    return `unknown type ${JSON.stringify(message.type)}`;
  }
  for (const [name, test] of Object.entries(fields)) {
    if (!test(message[name])) return `${String(message.type)}: ${name} is not as expected`;
  }
  return message as unknown as Message;
}
