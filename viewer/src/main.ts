// Puts the page together: scene, connection, panel, hand.

import { type ChainView, load_chain } from "./chain_view";
import { Connection } from "./connection";
import { Drag } from "./drag";
import { connect_hand_controls, show_hand } from "./hand_controls";
import { HandleView } from "./handle_view";
import type { Frame, Scene, Vec3 } from "./messages";
import { Panel, element, show_connection } from "./panel";
import { Stage } from "./stage";
import { is_complete } from "./text";

const TWIN_OPACITY = 0.8; // it is not there: the device shines through

// What tests and the console may look at.
export interface PageState {
  readonly scene: Scene;
  readonly frame: Frame | null;
  readonly frames_per_second: number;
  readonly is_connected: boolean;
  readonly handle_on_screen: { x: number; y: number } | null;
  on_screen(p_B: Vec3): { x: number; y: number };
}

declare global {
  interface Window {
    hapticgiant: PageState;
  }
}

async function load_scene(): Promise<Scene> {
  const response = await fetch("/scene.json");
  if (!response.ok) throw new Error(`scene: ${await response.text()}`);
  return response.json();
}

async function start(): Promise<void> {
  const scene = await load_scene();
  const device = await load_chain(scene.device, 1);
  const twin = await load_chain(scene.twin, TWIN_OPACITY);
  const stage = new Stage(element("stage"));
  const panel = new Panel(scene);
  const handle_view = new HandleView();
  stage.frame(scene.box, scene.floor_z_m);
  stage.scene.add(device.placement, twin.placement, handle_view.group);

  let newest: Frame | null = null;
  const connection = new Connection({
    on_frame: (frame) => {
      if (!is_complete(frame)) return;
      if (!newest) stage.look_at(frame.p_B_H_m);
      newest = frame;
    },
    on_event: (event) => panel.add_event(event),
    on_state: (is_connected) => {
      show_connection(is_connected);
      if (is_connected) panel.clear_events(); // the program sends them all again
    },
  });
  const handle = (): Vec3 | null => (newest && connection.is_connected ? newest.p_B_H_m : null);
  const drag = new Drag(stage, handle, (hand) => connection.send(hand));
  connect_hand_controls(drag, scene);
  connect_visibility("show-device", device);
  connect_visibility("show-twin", twin);

  stage.run(() => {
    if (!newest) return;
    device.pose(newest.q_device);
    twin.pose(newest.q_twin);
    handle_view.show_force(newest.p_B_H_m, newest.force_N);
    handle_view.show_target(newest.p_B_H_m, drag.target_m ?? seen_target(newest));
    show_hand(drag, stage.on_screen(newest.p_B_H_m));
    panel.show(newest, connection.frames_per_second());
  });

  window.hapticgiant = Object.freeze({
    scene,
    get frame() {
      return newest;
    },
    get frames_per_second() {
      return connection.frames_per_second();
    },
    get is_connected() {
      return connection.is_connected;
    },
    get handle_on_screen() {
      return newest && stage.on_screen(newest.p_B_H_m);
    },
    on_screen: (p_B: Vec3) => stage.on_screen(p_B),
  });
}

// Where another page drags the handle to.
function seen_target(frame: Frame): Vec3 | null {
  return frame.hand.active ? frame.hand.p_B_m : null;
}

function connect_visibility(id: string, view: ChainView): void {
  const box = element<HTMLInputElement>(id);
  box.addEventListener("change", () => (view.placement.visible = box.checked));
}

start().catch((error: unknown) => {
  const line = element("connection");
  line.dataset.state = "lost";
  line.textContent = error instanceof Error ? error.message : String(error);
});
