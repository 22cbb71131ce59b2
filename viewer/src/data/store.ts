// All data of the page: connection -> store -> views. Views read; only the store changes.

import type { Event, Frame, Scene, Values } from "../messages";
import { Commands, type Refusal } from "./commands";
import { Connection } from "./connection";
import { Freshness, type Link, TICK_MS } from "./freshness";
import { Table, history_of, row_of } from "./history";
import { Holder } from "./holder";
import { RateMeter } from "./rate_meter";
import type { Message } from "./read_message";
import { authorization } from "./token";

const RETRY_MS = 1000; // of the scene
const BACK_S = 0.05; // time that goes back by less has been rounded

interface Listener {
  on_scene?(scene: Scene): void; // another run has started, or the first one
  on_frame?(frame: Frame): void;
  on_event?(event: Event): void;
  on_events_cleared?(): void;
  on_values?(values: Values): void;
  on_connection?(is_connected: boolean): void;
  on_refusal?(refusal: Refusal): void;
  on_unreadable?(count: number, reason: string): void;
}

export class Store {
  scene: Scene | null = null;
  frame: Frame | null = null; // of the scene's run
  history = new Table(["time_s"]);
  private values: Values | null = null; // may come before their scene
  unreadable = 0; // messages that were not as expected
  page = -1; // number of this connection
  readonly commands: Commands;
  readonly connection: Connection;
  readonly holder: Holder;
  private readonly freshness = new Freshness();
  private readonly rate = new RateMeter();
  private readonly listeners: Listener[] = [];
  private is_loading = false;

  constructor() {
    this.connection = new Connection({
      on_message: (message) => this.take(message),
      on_refused: (reason) => this.note_unreadable(reason),
      on_state: (is_connected) => this.note_state(is_connected),
    });
    this.holder = new Holder((hold) => this.connection.send(hold));
    this.commands = new Commands(
      (command) => {
        const is_sent = this.connection.send(command);
        if (is_sent) this.holder.note(command);
        return is_sent;
      },
      (refusal) => this.notify((listener) => listener.on_refusal?.(refusal)),
    );
    setInterval(() => this.freshness.tick(), TICK_MS);
  }

  get is_connected(): boolean {
    return this.connection.is_connected;
  }

  // Whether what the frame says is still so.
  get link(): Link {
    const state = this.frame?.run_state;
    const is_expected = state !== undefined && !state.is_paused && !state.is_over;
    return this.freshness.link(this.is_connected, is_expected);
  }

  frames_per_second(): number {
    return this.rate.per_second(performance.now() / 1000);
  }

  subscribe(listener: Listener): void {
    this.listeners.push(listener);
    if (this.scene) listener.on_scene?.(this.scene);
  }

  private notify(what: (listener: Listener) => void): void {
    for (const listener of this.listeners) what(listener);
  }

  private take(message: Message): void {
    if (message.type === "frame") this.take_frame(message);
    else if (message.type === "event") this.notify((listener) => listener.on_event?.(message));
    else if (message.type === "values") this.take_values(message);
    else if (message.type === "welcome") this.page = message.page;
    else this.commands.take(message);
  }

  private take_values(values: Values): void {
    this.values = values;
    if (values.values.length !== this.scene?.settings.length) return;
    this.notify((listener) => listener.on_values?.(values));
  }

  private take_frame(frame: Frame): void {
    if (frame.run !== this.scene?.run) return void this.load_scene();
    const problem = mismatch(this.scene, frame);
    if (problem) return this.note_unreadable(problem);
    this.rate.tick(performance.now() / 1000);
    this.freshness.note();
    this.frame = frame;
    this.note(this.scene, frame);
    this.notify((listener) => listener.on_frame?.(frame));
  }

  // Times of the history rise; a step back is a place that was sought, or a restart.
  private note(scene: Scene, frame: Frame): void {
    const step = this.history.length > 0 ? frame.time_s - this.history.last("time_s") : Infinity;
    if (step < -BACK_S) this.history.clear();
    if (step > 0 || step < -BACK_S) this.history.push(row_of(scene, frame));
  }

  private note_unreadable(reason: string): void {
    this.unreadable += 1;
    this.notify((listener) => listener.on_unreadable?.(this.unreadable, reason));
  }

  private note_state(is_connected: boolean): void {
    this.commands.forget();
    this.holder.end();
    this.freshness.note();
    if (is_connected) {
      this.notify((listener) => listener.on_events_cleared?.()); // all are sent again
      void this.load_scene(); // the program may be another one now
    }
    this.notify((listener) => listener.on_connection?.(is_connected));
  }

  private async load_scene(): Promise<void> {
    if (this.is_loading) return;
    this.is_loading = true;
    try {
      const response = await fetch("/scene.json", { headers: authorization() });
      if (!response.ok) throw new Error(await response.text());
      const scene = (await response.json()) as Scene;
      this.frame = null;
      this.scene = scene;
      this.history = history_of(scene);
      this.notify((listener) => listener.on_scene?.(scene));
      if (this.values) this.take_values(this.values);
    } catch {
      if (this.is_connected) setTimeout(() => void this.load_scene(), RETRY_MS);
    } finally {
      this.is_loading = false;
    }
  }
}

// Why a frame does not fit to the scene; empty = it does.
function mismatch(scene: Scene, frame: Frame): string {
  const count = (joints: Scene["twin"]["joints"]): number =>
    joints.reduce((sum, joint) => sum + (joint.type === "floating" ? 7 : 1), 0);
  if (frame.q_device.length !== count(scene.device.joints))
    return "frame: q_device has other joints";
  if (frame.q_twin.length !== count(scene.twin.joints)) return "frame: q_twin has other joints";
  if (frame.limit_position.length !== scene.limits.length) return "frame: other limits";
  return "";
}
