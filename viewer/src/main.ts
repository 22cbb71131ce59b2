// Puts the page together: store, scene, panels, hand.

import { TICK_MS } from "./data/freshness";
import { Store } from "./data/store";
import { token, watch_token } from "./data/token";
import { Drag } from "./hand/drag";
import { HandControls } from "./hand/hand_controls";
import type { Event, Frame, Scene, Vec3 } from "./messages";
import { element, write } from "./page";
import { ChangePanel } from "./panels/change";
import { EventsPanel } from "./panels/events";
import { FeelPanel } from "./panels/feel";
import { JointsPanel } from "./panels/joints";
import { Notices } from "./panels/notices";
import { SafetyPanel } from "./panels/safety";
import { Tabs } from "./panels/tabs";
import { PlotDrawer } from "./plots/drawer";
import { Glossary } from "./guide/glossary";
import { show_guide } from "./guide/guide";
import { Legend } from "./guide/legend";
import { ReplayBar } from "./replay_bar";
import { show_part } from "./part";
import { Cameras } from "./scene/cameras";
import { FirstView } from "./scene/first_view";
import { Layers } from "./scene/layers";
import { type Pixel, Stage } from "./scene/stage";
import { World } from "./scene/world";
import { connection_text } from "./text";
import { StopButton } from "./stop_button";
import { current_theme, on_theme_change, start_theme } from "./theme";
import { Toolbar, build_view_tools } from "./toolbar";
import { Headset } from "./xr/headset";

const NEWS_S = 1; // a page that is opened later gets earlier events, too
const PANEL_GAP_MS = 66; // words and bars change 15 times a second

// What tests and the console may look at.
export interface PageState {
  readonly scene: Scene | null;
  readonly frame: Frame | null;
  readonly frames_per_second: number;
  readonly frames: number; // since the page was loaded
  readonly is_connected: boolean;
  readonly page: number; // of this connection
  readonly is_drawn: boolean; // the scene of the newest run
  readonly unreadable: number;
  readonly is_hand_tracked: boolean; // by a headset
  readonly handle_on_screen: Pixel | null;
  on_screen(p_B: Vec3): Pixel;
}

declare global {
  interface Window {
    hapticgiant: PageState;
  }
}

class Page {
  private readonly store = new Store();
  private readonly stage = new Stage(element("stage"));
  private readonly cameras = new Cameras(this.stage.camera, this.stage.canvas);
  private readonly layers = new Layers(() => {
    this.world?.apply_layers();
    this.legend.apply_layers();
  });
  private readonly legend = new Legend(this.layers);
  private readonly drag = new Drag(
    this.stage,
    this.cameras,
    () => this.live_frame,
    (hand) => this.store.connection.send(hand),
  );
  private readonly hand_controls = new HandControls(this.drag);
  private readonly headset: Headset;
  private readonly tabs = new Tabs();
  private readonly stop = new StopButton(this.store.commands, () => this.tabs.show("safety"));
  private readonly toolbar = new Toolbar(this.store, () => this.tabs.show("safety"));
  private readonly replay = new ReplayBar(this.store);
  private readonly feel = new FeelPanel(element("feel"));
  private readonly joints = new JointsPanel(element("joints"));
  private readonly change = new ChangePanel(element("change"), this.store.commands);
  private readonly safety = new SafetyPanel(
    element("safety"),
    this.store.commands,
    () => this.store.page,
  );
  private readonly events = new EventsPanel(element("events"));
  private readonly notices = new Notices();
  private readonly plots = new PlotDrawer(element("plots"), this.store);
  private world: World | null = null;
  private has_looked = false; // the first view has been chosen
  private readonly happened: Event[] = [];
  private frames = 0;
  private panels_ms = 0;

  constructor() {
    build_view_tools(this.cameras, this.layers, () => this.plots.toggle());
    this.headset = new Headset(
      this.stage,
      () => this.live_frame,
      (hand) => this.store.connection.send(hand),
      (problem) => this.notices.show("headset", problem),
    );
    on_theme_change(() => this.world?.paint(current_theme()));
    this.stage.on_resize = () => this.cameras.resize();
    this.listen();
    this.stage.run((now_ms) => this.draw(now_ms));
    setInterval(() => this.show_link(), TICK_MS); // also while nothing is drawn
    document.addEventListener("visibilitychange", () => {
      if (document.hidden) this.store.holder.end();
    });
  }

  private listen(): void {
    this.store.subscribe({
      on_scene: (scene) => void this.load(scene),
      on_frame: (frame) => this.note(frame),
      on_event: (event) => {
        this.events.add(event);
        this.happened.push(event);
        if (event.run === this.world?.scene.run) this.world.happened(event.name);
        const { scene, frame } = this.store;
        const is_new = scene?.source === "run" && event.time_s > (frame?.time_s ?? Infinity) - NEWS_S;
        if (event.name === "request" && is_new) this.notices.show("request", event.text);
      },
      on_events_cleared: () => {
        this.events.clear();
        this.happened.length = 0;
      },
      on_values: (values) => this.change.take(values),
      on_connection: (is_connected) => {
        if (!is_connected) this.release();
        show_connection(is_connected);
        this.show_link();
      },
      on_refusal: (refusal) => {
        this.change.refuse(refusal);
        this.toolbar.refuse();
        this.notices.show(refusal.command, `${refusal.command}: ${refusal.reason}`);
      },
      on_unreadable: (count, reason) => {
        const times = count === 1 ? "A message" : `${count} messages`;
        this.notices.show("unreadable", `${times} of the program could not be read (${reason}).`);
      },
    });
  }

  // What the hand acts upon.
  private get live_frame(): Frame | null {
    return this.store.is_connected ? this.store.frame : null;
  }

  private release(): void {
    this.drag.release();
    this.headset.release();
  }

  private async load(scene: Scene): Promise<void> {
    this.release(); // the handle is elsewhere now
    const is_other = this.world?.scene.device.name !== scene.device.name; // than seen so far, if any
    this.toolbar.load(scene);
    this.stop.load(scene);
    this.replay.load(scene);
    this.joints.load(scene);
    this.change.load(scene);
    this.safety.load(scene);
    this.plots.load(scene);
    this.hand_controls.load(scene);
    document.body.dataset.source = scene.source;
    this.stage.load(scene.box, scene.floor_z_m);
    if (is_other) {
      this.cameras.frame(scene.box);
      if (document.body.dataset.show === "hand" && scene.checkpoints.length > 0) choose_top_view();
      this.has_looked = false;
    }
    const world = await World.load(scene, this.stage, this.layers).catch((error: unknown) => {
      this.notices.show("world", error instanceof Error ? error.message : String(error));
      return null;
    });
    if (this.store.scene !== scene) return world?.dispose(); // another one has come meanwhile
    if (!world) return;
    this.world?.dispose();
    this.world = world;
    for (const { run, name } of this.happened) if (run === scene.run) world.happened(name); // before it was there
    world.paint(current_theme());
    this.stage.scene.add(world.root);
  }

  // What has to be right whatever is drawn: whether it is known, the state, and the stop.
  private show_link(): void {
    const { link, frame, page } = this.store;
    document.body.dataset.stale = String(link !== "open");
    this.toolbar.show_mode(frame, link);
    this.stop.show(link, frame?.safety ?? null, page);
  }

  private note(frame: Frame): void {
    this.frames += 1;
    this.world?.note(frame);
  }

  private look(world: World, frame: Frame): void {
    this.has_looked = true;
    const first = new FirstView(world.sights(frame));
    this.cameras.begin_with(() => first.sight(this.stage.camera));
  }

  private draw(now_ms: number): void {
    const { scene, frame } = this.store;
    if (!scene || !frame || this.world?.scene !== scene) return;
    if (!this.has_looked) this.look(this.world, frame);
    this.legend.show(frame.ghost !== null);
    const target = this.drag.target_m ?? this.headset.target_m ?? seen_target(frame);
    this.world.show(frame, target, this.drag.axis);
    const is_first_person = this.cameras.current === "first person" || this.headset.is_worn;
    this.world.person.hide_body(is_first_person);
    if (!this.headset.is_worn) this.cameras.update(frame.p_B_H_m, this.world.person.eyes);
    const follows = frame.mode === "running" && !frame.run_state.is_over;
    const handle_px = follows && !this.headset.is_worn ? this.stage.on_screen(frame.p_B_H_m) : null;
    this.hand_controls.show(handle_px, Math.hypot(...frame.force_N));
    if (now_ms - this.panels_ms < PANEL_GAP_MS) return;
    this.panels_ms = now_ms;
    this.show_panels(scene, frame);
  }

  private show_panels(scene: Scene, frame: Frame): void {
    this.show_link();
    this.toolbar.show(frame);
    this.replay.show(scene, frame);
    if (!element("feel").hidden) this.feel.show(scene, frame);
    if (!element("joints").hidden) this.joints.show(scene, frame);
    if (!element("safety").hidden) this.safety.show(frame);
    this.plots.show();
    write(element("sync"), `hand and twin ${(frame.sync_error_mm ?? 0).toFixed(1)} mm apart`);
    const cycle = `cycle ${(frame.cycle_time_us ?? 0).toFixed(0)} \u00b5s`;
    const delays = frame.latency && `; ${frame.latency}`;
    write(element("rates"), `${cycle}, ${this.store.frames_per_second()} frames/s${delays}`);
  }

  state(): PageState {
    const { store, stage, headset } = this;
    const is_drawn = (): boolean => this.world !== null && this.world.scene === store.scene;
    const count = (): number => this.frames;
    return Object.freeze({
      get scene() {
        return store.scene;
      },
      get frame() {
        return store.frame;
      },
      get frames_per_second() {
        return store.frames_per_second();
      },
      get frames() {
        return count();
      },
      get is_connected() {
        return store.is_connected;
      },
      get page() {
        return store.page;
      },
      get is_drawn() {
        return is_drawn();
      },
      get unreadable() {
        return store.unreadable;
      },
      get is_hand_tracked() {
        return headset.is_tracked;
      },
      get handle_on_screen() {
        return store.frame && stage.on_screen(store.frame.p_B_H_m);
      },
      on_screen: (p_B: Vec3) => stage.on_screen(p_B),
    });
  }
}

// Where another page drags the handle to.
function seen_target(frame: Frame): Vec3 | null {
  return frame.hand.active ? frame.hand.p_B_m : null;
}

// From where a person who drags the handle to places on the floor sees them.
function choose_top_view(): void {
  const views = element<HTMLSelectElement>("view");
  views.value = "top";
  views.dispatchEvent(new globalThis.Event("change"));
}

function show_connection(is_connected: boolean): void {
  const light = element("connection");
  light.dataset.state = is_connected ? "open" : "lost";
  document.body.dataset.connected = String(is_connected);
  write(light, connection_text(is_connected));
}

watch_token();
start_theme();
show_part();
if (token() === "") write(element("story"), "Open the link that the program printed: it has the token.");
window.hapticgiant = new Page().state();
show_guide(element("stage-area"));
new Glossary(element("panel"));
