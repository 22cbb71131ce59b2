// Puts the page together: store, scene, panels, hand.

import { TICK_MS } from "./data/freshness";
import { Store } from "./data/store";
import { token, watch_token } from "./data/token";
import { Film, is_film } from "./film";
import { Clutch } from "./hand/clutch";
import { Drag } from "./hand/drag";
import { HandControls } from "./hand/hand_controls";
import type { Pixel } from "./hand/hand_view";
import { HolderNote, is_taken } from "./hand/holder_note";
import { PushKeys } from "./hand/push_keys";
import { KeysDialog } from "./keys_dialog";
import type { Frame, Hand, Scene, Vec3 } from "./messages";
import { element, write } from "./page";
import { ChangePanel } from "./panels/change";
import { refusal_text } from "./panels/choices";
import { EventsPanel } from "./panels/events";
import { FeelPanel } from "./panels/feel";
import { JointsPanel } from "./panels/joints";
import { Notices } from "./panels/notices";
import { RemotePanel } from "./panels/remote";
import { SafetyPanel } from "./panels/safety";
import { Tabs } from "./panels/tabs";
import { PlotDrawer } from "./plots/drawer";
import { Glossary } from "./guide/glossary";
import { show_guide } from "./guide/guide";
import { ReplayBar } from "./replay_bar";
import { offers_hand, show_part } from "./part";
import { open_picture } from "./picture/open_picture";
import type { Picture } from "./picture/picture";
import { connection_text } from "./text";
import { StopButton } from "./stop_button";
import { start_theme } from "./theme";
import { Toolbar, build_page_tools } from "./toolbar";

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
  readonly is_flat: boolean; // without WebGL
  readonly handle_on_screen: Pixel | null;
  on_screen(p_B: Vec3): Pixel;
  readonly film: Film | null; // show=picture
}

declare global {
  interface Window {
    hapticgiant: PageState;
  }
}

class Page {
  private readonly store = new Store();
  private readonly notices = new Notices();
  private readonly picture: Picture;
  private readonly drag: Drag;
  private readonly push_keys: PushKeys;
  private readonly hand_controls: HandControls;
  private readonly clutch: Clutch;
  private readonly holder = new HolderNote(this.store.commands, () => this.store.page);
  private readonly tabs = new Tabs();
  private readonly stop = new StopButton(this.store.commands, () => this.tabs.show("safety"));
  private readonly toolbar = new Toolbar(this.store, () => this.tabs.show("safety"));
  private readonly replay = new ReplayBar(this.store);
  private readonly feel = new FeelPanel(element("feel"));
  private readonly joints = new JointsPanel(element("joints"));
  private readonly remote = new RemotePanel(element("remote"), this.store);
  private readonly change = new ChangePanel(element("change"), this.store.commands, (problem) =>
    this.notices.show("change", problem),
  );
  private readonly safety = new SafetyPanel(
    element("safety"),
    this.store.commands,
    () => this.store.page,
  );
  private readonly events = new EventsPanel(element("events"));
  private readonly plots = new PlotDrawer(element("plots"), this.store);
  private readonly film: Film | null;
  private frames = 0;
  private panels_ms = 0;

  constructor() {
    const live_frame = (): Frame | null => this.live_frame;
    const send = (hand: Hand): void => void this.store.connection.send(hand);
    this.picture = open_picture({
      live_frame,
      send,
      stop: () => this.store.commands.send("emergency_stop"),
      link: () => this.store.link,
      page: () => this.store.page,
      report: (key, text) => this.notices.show(key, text),
    });
    this.drag = new Drag(this.picture.view, live_frame, send);
    this.drag.on_refused = () => this.explain_hand();
    this.hand_controls = new HandControls(this.drag);
    this.clutch = new Clutch(this.store.commands, live_frame);
    this.push_keys = new PushKeys(this.drag, this.picture.view);
    const keys = new KeysDialog(this.picture.has_cameras);
    build_page_tools(this.plots, () => keys.toggle());
    this.listen();
    const prepare = (now_ms: number): void => this.draw(now_ms);
    this.film = is_film() ? new Film(this.store, prepare, () => this.picture.draw()) : null;
    if (!this.film) this.picture.run(prepare);
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
        this.picture.happened(event);
        const { scene, frame } = this.store;
        const is_new = scene?.source === "run" && event.time_s > (frame?.time_s ?? Infinity) - NEWS_S;
        if (event.name === "request" && is_new) this.notices.show("request", event.text);
      },
      on_events_cleared: () => {
        this.events.clear();
        this.picture.forget_events();
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
        this.notices.show(refusal.command, refusal_text(refusal));
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
    this.picture.release();
  }

  // Why it cannot be taken hold of.
  private explain_hand(): void {
    if (!offers_hand()) return;
    const { frame, page } = this.store;
    if (frame && is_taken(frame, page)) {
      this.notices.show("hand", `Page ${frame.hand_page} has the hand: ask for it, or wait until it lets go.`);
    }
  }

  private async load(scene: Scene): Promise<void> {
    this.release(); // the handle is elsewhere now
    this.toolbar.load(scene);
    this.stop.load(scene);
    this.replay.load(scene);
    this.joints.load(scene);
    this.tabs.load(scene);
    this.remote.load(scene);
    this.change.load(scene);
    this.safety.load(scene);
    this.plots.load(scene);
    this.hand_controls.load(scene);
    this.push_keys.load(scene);
    this.clutch.load(scene);
    this.holder.load(scene);
    document.body.dataset.source = scene.source;
    await this.picture.load(scene, () => this.store.scene === scene);
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
    const { scene, page } = this.store;
    if (!scene) return;
    this.picture.note(frame);
    const is_ours = scene.source === "run" && offers_hand() && !is_taken(frame, page);
    if (!is_ours && this.drag.can_hold) this.drag.release(); // another page was faster
    this.drag.can_hold = is_ours;
    document.body.dataset.hand = is_ours ? "free" : "taken";
  }

  private draw(now_ms: number): void {
    const { scene, frame } = this.store;
    if (!scene || !frame) return;
    const { picture } = this;
    if (picture.scene === scene) {
      const target = this.drag.target_m ?? picture.target_m ?? seen_target(frame);
      picture.show(frame, target, this.drag.axis);
      const follows = frame.mode === "running" && !frame.run_state.is_over && this.drag.can_hold;
      const handle_px = follows && !picture.is_worn ? picture.on_screen(frame.p_B_H_m) : null;
      this.hand_controls.show(handle_px, Math.hypot(...frame.force_N));
    }
    if (now_ms - this.panels_ms < PANEL_GAP_MS) return;
    this.panels_ms = now_ms;
    this.show_panels(scene, frame);
  }

  private show_panels(scene: Scene, frame: Frame): void {
    this.show_link();
    this.toolbar.show(frame);
    this.replay.show(scene, frame);
    this.holder.show(frame);
    if (!element("feel").hidden) this.feel.show(scene, frame);
    if (!element("remote").hidden) this.remote.show(scene, frame);
    this.clutch.show(frame, this.drag.can_hold);
    if (!element("joints").hidden) this.joints.show(scene, frame);
    if (!element("safety").hidden) this.safety.show(frame);
    this.plots.show();
    write(element("sync"), `hand and twin ${(frame.sync_error_mm ?? 0).toFixed(1)} mm apart`);
    const cycle = `cycle ${(frame.cycle_time_us ?? 0).toFixed(0)} \u00b5s`;
    const delays = frame.latency && `; ${frame.latency}`;
    write(element("rates"), `${cycle}, ${this.store.frames_per_second()} frames/s${delays}`);
  }

  state(): PageState {
    const { store, picture } = this;
    const is_drawn = (): boolean => picture.scene !== null && picture.scene === store.scene;
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
        return picture.is_hand_tracked;
      },
      is_flat: element("stage").classList.contains("is-flat"),
      get handle_on_screen() {
        return store.frame && picture.on_screen(store.frame.p_B_H_m);
      },
      on_screen: (p_B: Vec3) => picture.on_screen(p_B),
      film: this.film,
    });
  }
}

// Where another page drags the handle to.
function seen_target(frame: Frame): Vec3 | null {
  return frame.hand.active ? frame.hand.p_B_m : null;
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
