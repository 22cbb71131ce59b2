// The words and bars beside the scene.

import type { Event, Frame, Scene, SceneJoint } from "./messages";
import { felt_text, force_of, joint_text, share_of_range, time_text } from "./text";

const FORCE_OF_FULL_BAR = 80; // N
const MOST_EVENTS = 100;

export function element<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`page has no element ${id}`);
  return found as T;
}

function set_text(id: string, text: string): void {
  const part = element(id);
  if (part.textContent !== text) part.textContent = text;
}

interface JointRow {
  joint: SceneJoint;
  first: number; // of its coordinates
  value: HTMLElement;
  bar: HTMLElement;
}

export class Panel {
  private readonly rows: JointRow[] = [];

  constructor(private readonly scene: Scene) {
    set_text("title", scene.title);
    document.title = `${scene.title} - HapticGiant`;
    let first = 0;
    for (const joint of scene.twin.joints) {
      if (joint.type !== "floating") this.rows.push(this.add_row(joint, first));
      first += joint.type === "floating" ? 7 : 1;
    }
    element("joints").parentElement!.hidden = this.rows.length === 0;
  }

  show(frame: Frame, frames_per_second: number): void {
    set_text("mode", frame.mode);
    element("mode").dataset.mode = frame.mode;
    set_text("time", time_text(frame.time_s));
    set_text("fault", frame.fault);
    element("fault").hidden = frame.fault === "";
    set_text("status", frame.status);

    const force = force_of(frame);
    set_text("force-value", force.toFixed(force < 10 ? 1 : 0));
    set_share(element("force-bar"), force / FORCE_OF_FULL_BAR);
    set_text("felt", felt_text(frame));
    element("felt").dataset.held = String(frame.felt !== null);

    for (const row of this.rows) this.show_joint(row, frame.q_twin[row.first] ?? NaN);
    set_text("sync", `hand and twin ${(frame.sync_error_mm ?? 0).toFixed(1)} mm apart`);
    const cycle = `cycle ${(frame.cycle_time_us ?? 0).toFixed(0)} \u00b5s`;
    set_text("rates", `${cycle}, ${frames_per_second} frames/s`);
  }

  add_event(event: Event): void {
    const line = document.createElement("li");
    const time = document.createElement("time");
    time.textContent = time_text(event.time_s);
    const name = document.createElement("b");
    name.textContent = event.name;
    line.append(time, name, ` ${event.text}`);
    const list = element("events");
    list.prepend(line);
    while (list.children.length > MOST_EVENTS) list.lastElementChild!.remove();
  }

  clear_events(): void {
    element("events").replaceChildren();
  }

  private add_row(joint: SceneJoint, first: number): JointRow {
    const row = document.createElement("div");
    const name = document.createElement("span");
    const value = document.createElement("output");
    const bar = document.createElement("div");
    row.className = "joint";
    bar.className = "bar";
    name.textContent = joint.name;
    bar.append(document.createElement("i"));
    row.append(name, value, bar);
    element("joints").append(row);
    return { joint, first, value, bar };
  }

  private show_joint(row: JointRow, q: number): void {
    row.value.textContent = joint_text(q, row.joint);
    const limit = this.scene.limits.find((l) => l.kind === "twin" && l.name === row.joint.name);
    const share = share_of_range(q, limit);
    row.bar.hidden = share === null;
    set_share(row.bar, share ?? 0);
  }
}

export function show_connection(is_connected: boolean): void {
  const line = element("connection");
  line.dataset.state = is_connected ? "open" : "lost";
  document.body.dataset.connected = String(is_connected);
  line.textContent = is_connected
    ? "connected"
    : "connection lost, trying again; if the program was restarted, open its new link";
}

function set_share(bar: HTMLElement, share: number): void {
  const fill = bar.firstElementChild as HTMLElement;
  fill.style.transform = `scaleX(${Math.min(1, Math.max(0, share)).toFixed(3)})`;
}
