// Numbers and states in words. Pure functions.

import type { Link } from "./data/freshness";
import type { Frame, Scene, SceneJoint } from "./messages";
import { causes, names_limits, summary } from "./panels/budget";

// "Drawer, Franka FR3": what is rendered, and by which device.
export function heading_text({ title, device }: Scene): string {
  const is_named = device.name === "" || title.includes(device.name);
  return with_capital(is_named ? title : `${title}, ${device.name}`);
}

// "as in the scenario (cupboard)", or the twin that was chosen instead: "Drawer".
export function twin_text({ choices, twin }: Scene): string {
  if (choices.twin !== "") return with_capital(twin.name);
  return twin.name === "" ? "as in the scenario" : `as in the scenario (${twin.name})`;
}

// The same of the device.
export function device_text({ choices, device }: Scene): string {
  if (choices.device !== "") return device.name || choices.device;
  return device.name === "" ? "as in the scenario" : `as in the scenario (${device.name})`;
}

// "as in the scenario (6)"; of a choice, "" = as it is listed.
export function surfaces_text({ choices, surfaces }: Scene): string {
  if (choices.surfaces !== "") return "";
  return `as in the scenario (${surfaces.length === 0 ? "none" : surfaces.length})`;
}

export function with_capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

export function time_text(time_s: number): string {
  const tenths = Math.round(10 * time_s);
  const seconds = ((tenths % 600) / 10).toFixed(1).padStart(4, "0");
  return `${Math.floor(tenths / 600)}:${seconds}`;
}

export function joint_text(value: number, joint: Pick<SceneJoint, "type">): string {
  if (!Number.isFinite(value)) return "-";
  return joint.type === "prismatic"
    ? `${(100 * value).toFixed(1)} cm`
    : `${((value * 180) / Math.PI).toFixed(1)}\u00b0`;
}

// "12.0 Nm of 176 Nm"
export function effort_text(effort: number, joint: Pick<SceneJoint, "type" | "tau_max">): string {
  if (!Number.isFinite(effort)) return "not measured";
  const unit = joint.type === "prismatic" ? "N" : "Nm";
  const most = joint.tau_max === null ? "" : ` of ${joint.tau_max} ${unit}`;
  return `${effort.toFixed(1)} ${unit}${most}`;
}

// Share of the way between two ends, 0..1; null when there are no two ends.
export function share_between(
  value: number,
  min: number | null,
  max: number | null,
): number | null {
  if (min === null || max === null || max <= min || !Number.isFinite(value)) return null;
  return Math.min(1, Math.max(0, (value - min) / (max - min)));
}

function force_of(frame: Frame): number {
  const force = Math.hypot(...frame.force_N);
  return Number.isFinite(force) ? force : 0;
}

// Nms^2/rad^2 as it is written by hand.
export function unit_text(unit: string): string {
  return unit.replaceAll("^2", "\u00b2").replaceAll("^3", "\u00b3");
}

const SMALLEST_FORCE = 1; // N; below both, hands feel nothing
const SMALLEST_CONTACT = 0.1; // N
const SMALLEST_TORQUE = 0.2; // Nm

// Whether the user pushes or turns at all: a limit may also be pushed by gravity alone.
export function is_pushing(frame: Frame): boolean {
  return force_of(frame) >= SMALLEST_FORCE || Math.hypot(...frame.torque_Nm) >= SMALLEST_TORQUE;
}

/** The virtual surface that pushes: of one whose share is 0 nothing is felt. */
export function felt_contact({ contact }: Frame): Frame["contact"] {
  return contact && Math.hypot(...contact.force) >= SMALLEST_CONTACT ? contact : null;
}

// Why the hand feels what it feels, the largest cause first.
export function felt_text(scene: Scene, frame: Frame): string {
  if (!is_pushing(frame)) {
    return frame.active.length > 0
      ? "You do not push. What holds all the same:"
      : "You do not push, so nothing pushes back.";
  }
  const found = causes(frame.budget);
  const first = found[0]?.part;
  if (first === "limits" && frame.felt) return frame.felt.text;
  const contact = felt_contact(frame);
  if (first === "surface" && contact) {
    const size = Math.hypot(...contact.force);
    const { name } = scene.surfaces[contact.surface]!;
    return `Virtual surface ${name}: ${size.toFixed(size < 9.95 ? 1 : 0)} N.`;
  }
  const words = summary(found, frame.felt?.text.replace(/\.$/, ""));
  if (words === "") return "Nothing holds you.";
  if (names_limits(found)) return `${with_capital(words)}.`;
  return frame.active.length > 0 ? `Hardly a limit: ${words}.` : `No limit: ${words}.`;
}

// A fault, why the device does not follow the hand, or how a run begins again.
export function note_text(frame: Frame, is_run: boolean): string {
  const cause = frame.safety.cause || frame.fault;
  if (is_run && frame.run_state.is_over) {
    return `${cause || "The run is over."} The round arrow at the top (R) starts it again.`;
  }
  if (cause !== "") return cause;
  return frame.is_clamped ? "The device lost track of its reference and catches up." : "";
}

interface ModeText {
  text: string;
  kind: string; // how it is painted
}

// The state in the bar. An outdated state is not shown.
export function mode_text(frame: Frame | null, link: Link): ModeText {
  if (link === "lost") return { text: "no connection", kind: "unknown" };
  if (link === "silent") return { text: "no data", kind: "unknown" };
  if (!frame) return { text: "-", kind: "off" };
  if (frame.run_state.is_over) return { text: "over", kind: "over" };
  const is_alone = frame.mode === "running" && frame.safety.is_autonomous;
  if (frame.run_state.is_paused) {
    return { text: is_alone ? "paused, alone" : "paused", kind: "paused" };
  }
  return is_alone ? { text: "running alone", kind: "alone" } : { text: frame.mode, kind: frame.mode };
}

export function connection_text(is_connected: boolean): string {
  return is_connected
    ? "connected"
    : "connection lost, trying again; if the program was restarted, open its new link";
}
