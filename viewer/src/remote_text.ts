// A teleoperation in words: the clutch, the link, and who holds back whom. Pure functions.

import { apart } from "./data/history";
import type { SceneTeleoperation, Teleoperation } from "./messages";
import { with_capital } from "./text";

const SMALLEST_FORCE = 0.5; // N or Nm; below, nothing is felt
const FAR = { tool: 0.02, joints: 0.035 }; // m, rad; nearer, the machine follows closely
const TOGETHER_RAD = 0.02; // of joints, for the clutch to take hold (hg/config/simulation)
const SILENT_S = 0.2; // without packets both sides hold (hg/teleoperation)

export const METHODS: Record<string, string> = {
  position_force: "position to the remote machine, its measured force back",
  four_channel: "positions and forces both ways, with a spring between both sides",
  wave_variables: "waves of power: the link stores energy, and never makes any",
  passivity_control: "each side counts energy and gives no more than the other took",
  model_mediated: "a model of what the remote machine touches is felt without delay",
};

// "position_force" of a method that is not listed, as it is written.
export function method_text({ method }: SceneTeleoperation): string {
  const words = METHODS[method];
  const name = with_capital(method.replaceAll("_", " "));
  return words === undefined ? name : `${name}: ${words}.`;
}

export function force_unit({ mapping }: SceneTeleoperation): "N" | "Nm" {
  return mapping === "tool" ? "N" : "Nm";
}

export function force_text(scene: SceneTeleoperation, size: number): string {
  return `${size.toFixed(size < 9.95 ? 1 : 0)} ${force_unit(scene)}`;
}

// On the hand, at its own scale.
export function force_on_hand(scene: SceneTeleoperation, { f_leader }: Teleoperation): number {
  return scene.force_scale * Math.hypot(...f_leader);
}

// "engaged", "open", "fading", "lost", "waiting".
export function clutch_state(now: Teleoperation): string {
  const is_fading = Math.hypot(...now.f_leader) > 0.05 && now.link !== "engaged";
  if (is_fading) return "fading";
  return now.link === "released" ? "open" : now.link;
}

const CLUTCH: Record<string, string> = {
  engaged: "Clutch: engaged",
  open: "Clutch: open",
  fading: "Clutch: force fades",
  lost: "Clutch: link lost",
  waiting: "Clutch: waiting",
  none: "Clutch",
};

export function clutch_text(now: Teleoperation): string {
  return CLUTCH[clutch_state(now)] ?? "Clutch";
}

// Between where the remote machine is to be and where it is; empty: it is not led.
export function apart_text(scene: SceneTeleoperation, now: Teleoperation): string {
  const distance = apart(now);
  if (distance === null) return "";
  if (scene.mapping === "tool") return `${(1000 * distance).toFixed(0)} mm`;
  const ways = now.x_target.map((x, i) => Math.abs(x - now.x_remote[i]!));
  const most = ways.indexOf(Math.max(...ways));
  return `${degrees(ways[most]!)} (${scene.axes[most]?.name ?? ""})`;
}

function degrees(angle: number): string {
  return `${((180 / Math.PI) * angle).toFixed(1)}\u00b0`;
}

function milliseconds(time_s: number): string {
  return `${(1000 * time_s).toFixed(0)} ms`;
}

export interface LinkText {
  round_trip: string;
  jitter: string;
  lost: string;
  age: string; // of the newest packet
}

// As measured; "-": nothing has arrived yet.
export function link_text({ link, round_trip_s, jitter_s, loss, age_s }: Teleoperation): LinkText {
  if (link === "none" || link === "waiting" || round_trip_s === 0) {
    return { round_trip: "-", jitter: "-", lost: "-", age: "-" };
  }
  return {
    round_trip: milliseconds(round_trip_s),
    jitter: milliseconds(jitter_s),
    lost: `${(100 * loss).toFixed(loss > 0 && loss < 0.095 ? 1 : 0)} %`,
    age: age_s < 1 ? milliseconds(age_s) : `${age_s.toFixed(1)} s`,
  };
}

const HOLDS: Partial<Record<Teleoperation["cause"], string>> = {
  not_finite: "a value that is no number has arrived",
  jump: "what it was sent jumped",
  replayed: "packets were repeated",
  frozen: "packets kept coming with the same content",
  stopped: "a rule of its own has stopped it",
  active: "more energy came back than it may give",
};

const AGAIN = "Open and close the clutch (C) to take hold again.";

// One sentence: who holds back whom, and what to do about it.
export function who_holds(scene: SceneTeleoperation, now: Teleoperation): string {
  switch (now.link) {
    case "none":
    case "waiting":
      return "Nothing has arrived from the remote machine yet.";
    case "released":
      return released_text(scene, now);
    case "lost":
      return lost_text(now);
    case "engaged":
      return engaged_text(scene, now);
  }
}

function lost_text(now: Teleoperation): string {
  const fades = clutch_state(now) === "fading" ? "the force fades" : "you feel no force";
  const holds = HOLDS[now.cause];
  if (holds !== undefined) return `The remote machine holds, because ${holds}: ${fades}. ${AGAIN}`;
  if (now.age_s <= SILENT_S + now.round_trip_s) {
    return `The link was silent and is back; the remote machine holds still. ${AGAIN}`;
  }
  return `The link is silent for ${now.age_s.toFixed(1)} s: ${fades}, the remote machine holds. ${AGAIN}`;
}

function released_text(scene: SceneTeleoperation, now: Teleoperation): string {
  const { x_target, x_remote, is_clutch_open } = now;
  const ways = x_target.map((x, i) => Math.abs(x - (x_remote[i] ?? x)));
  const most = ways.indexOf(Math.max(...ways));
  if (!is_clutch_open && scene.mapping === "joints" && (ways[most] ?? 0) > TOGETHER_RAD) {
    const name = scene.axes[most]?.name ?? "";
    return `Twin and remote machine are ${degrees(ways[most]!)} apart (${name}): bring the twin there, and the clutch closes.`;
  }
  const close = is_clutch_open ? " Close it (C) to lead on from where both are." : "";
  return `The clutch is open: your hand moves freely, the remote machine holds still.${close}`;
}

// The axis at one of its ends, with the position of that end.
function axis_at_end({ axes, mapping }: SceneTeleoperation, x: number[]): string {
  const near = mapping === "tool" ? 0.005 : 0.01;
  for (const [i, { name, min, max }] of axes.entries()) {
    const end = [min, max].find((value) => value !== null && Math.abs(value - x[i]!) < near);
    if (end === undefined || end === null) continue;
    const number = mapping === "tool" ? "" : `joint ${i + 1}, `;
    const at = mapping === "tool" ? `${end.toFixed(2)} m` : degrees(end);
    return ` (${number}${name} at ${at})`;
  }
  return "";
}

function engaged_text(scene: SceneTeleoperation, now: Teleoperation): string {
  const felt = force_on_hand(scene, now);
  const met = Math.hypot(...now.f_remote);
  const holds_you = felt < SMALLEST_FORCE ? "you feel nothing of it yet" : `it holds you back with ${force_text(scene, felt)}`;
  switch (now.cause) {
    case "range":
      return `The remote machine is at the end of its range${axis_at_end(scene, now.x_remote)}: ${holds_you}.`;
    case "speed":
      return `The remote machine moves as fast as it can and lags behind: ${holds_you}.`;
    case "acceleration":
      return `The remote machine speeds up as fast as it can: ${holds_you}.`;
    case "force":
      return `The remote machine pushes as hard as it can: ${holds_you}.`;
    default:
      break;
  }
  if (met >= SMALLEST_FORCE) {
    return `The remote machine presses something with ${force_text(scene, met)}: ${holds_you}.`;
  }
  if (felt >= SMALLEST_FORCE) {
    const distance = apart(now) ?? 0;
    const why = distance > FAR[scene.mapping] ? `lags ${apart_text(scene, now)} behind` : "touches nothing that it has measured";
    return `The remote machine ${why}, and holds you back with ${force_text(scene, felt)}.`;
  }
  return `The remote machine follows your hand, ${apart_text(scene, now)} behind; nothing holds either of you.`;
}
