// Headsets by WebXR: room and twin at true scale, a controller or a hand is the hand target. Trigger or
// pinch takes hold of the handle from wherever the controller is and moves it alike. Nothing moves the
// wearer but a squeeze, which places device and wearer again.

import { type PerspectiveCamera, Quaternion, Vector3 } from "three";

import type { Link } from "../data/freshness";
import { icon } from "../icons";
import type { Frame, Hand, Quaternion as Turn, Scene, Vec3 } from "../messages";
import { element, make_button } from "../page";
import type { Stage } from "../scene/stage";
import { Board } from "./board";
import { board_text } from "./board_text";
import { grip_target, placed_at, placed_rig } from "./grip";
import { Placement } from "./placement";
import { Pointer } from "./pointer";

const RESEND_MS = 33;

const SESSIONS = [
  ["immersive-vr", "VR", "Room and twin at true scale in a headset"],
  ["immersive-ar", "AR", "The twin in your own room, seen through a headset"],
] as const;

// What a headset needs of the page.
interface HeadsetInput {
  live_frame(): Frame | null;
  send(hand: Hand): void;
  stop(): void;
  link(): Link;
  page(): number;
  report(key: string, problem: string): void;
}

interface Grip {
  pointer: Pointer;
  from: Vector3; // controller when it took hold, in B
  attitude: Quaternion;
  handle: Vector3;
  handle_attitude: Quaternion;
}

export class Headset {
  private grip: Grip | null = null;
  private target: Vec3 | null = null;
  private turn: Turn | null = null;
  private view_before: PerspectiveCamera | null = null; // three moves the camera with the head
  private scene: Scene | null = null;
  private is_placing = false;
  private readonly pointers: Pointer[];
  private readonly board: Board;
  private readonly placement: Placement;

  constructor(
    private readonly stage: Stage,
    private readonly input: HeadsetInput,
  ) {
    const { xr } = stage.renderer;
    xr.enabled = true;
    xr.setReferenceSpaceType("local-floor");
    this.board = new Board(() => this.stop());
    this.placement = new Placement(stage.renderer);
    stage.rig.add(this.board.mesh, this.placement.ring);
    this.pointers = [0, 1].map((index) => new Pointer(xr, index, stage.rig));
    for (const pointer of this.pointers) this.connect(pointer);
    xr.addEventListener("sessionend", () => this.exit());
    setInterval(() => this.send_where(), RESEND_MS);
    void this.offer();
  }

  get is_worn(): boolean {
    return this.stage.renderer.xr.isPresenting;
  }

  // A controller is seen: its trigger counts from now on.
  get is_tracked(): boolean {
    return this.is_worn && this.pointers.some((pointer) => pointer.is_seen);
  }

  get target_m(): Vec3 | null {
    return this.target;
  }

  // Before each picture.
  update(scene: Scene, frame: Frame): void {
    this.scene = scene;
    if (!this.is_worn) return;
    this.placement.update();
    for (const pointer of this.pointers) pointer.update();
    const tips = this.pointers.map((pointer) => pointer.fingertip);
    this.board.touch(tips.filter((tip) => tip !== null));
    const text = board_text(scene, frame, this.input.link(), this.input.page());
    if (this.placement.is_active) {
      text.limit = "Point at the floor";
      text.reason = "The trigger, or a pinch, places the device there.";
    }
    this.board.show(text);
  }

  // Buttons for what browser and headset can do.
  private async offer(): Promise<void> {
    for (const [mode, text, title] of SESSIONS) {
      const is_there = await navigator.xr?.isSessionSupported(mode).catch(() => false);
      if (!is_there) continue;
      const button = make_button(text, title, () => {
        this.enter(mode).catch((error: unknown) =>
          this.input.report("headset", `${text}: ${String(error)}`),
        );
      });
      button.id = `enter-${text.toLowerCase()}`;
      button.className = "with-icon";
      button.prepend(icon("headset"));
      element("view-tools").append(button);
    }
  }

  private async enter(mode: XRSessionMode): Promise<void> {
    const is_see_through = mode === "immersive-ar";
    const session = await navigator.xr!.requestSession(mode, {
      requiredFeatures: ["local-floor"],
      optionalFeatures: ["hand-tracking", ...(is_see_through ? ["hit-test"] : [])],
    });
    this.place_before();
    this.view_before = this.stage.camera.clone();
    this.stage.set_see_through(is_see_through);
    this.board.mesh.visible = true;
    this.is_placing = is_see_through;
    await this.stage.renderer.xr.setSession(session);
  }

  private exit(): void {
    this.release();
    this.is_placing = this.board.mesh.visible = false;
    this.placement.end();
    this.stage.set_see_through(false);
    this.stage.rig.position.set(0, 0, 0);
    this.stage.rig.quaternion.identity();
    const { camera } = this.stage;
    if (this.view_before) camera.copy(this.view_before);
    this.stage.reset_view();
  }

  // The wearer stands before the handle.
  private place_before(): void {
    const frame = this.input.live_frame();
    if (!frame) return;
    const handle = new Vector3(...frame.p_B_H_m);
    this.put_rig(placed_rig(handle, to_user(frame), this.stage.floor_z_m));
  }

  // The handle is above where the ring is, turned to the wearer. False: it is nowhere.
  private place_at_ring(): boolean {
    const frame = this.input.live_frame();
    const { place } = this.placement;
    if (!this.is_placing || !frame || !place) return false;
    const head = this.stage.camera.position; // three has it in the space of the headset
    const handle = new Vector3(...frame.p_B_H_m);
    this.put_rig(placed_at(place, head, handle, to_user(frame), this.stage.floor_z_m));
    this.is_placing = false;
    this.placement.end();
    return true;
  }

  private put_rig({ position, quaternion }: { position: Vector3; quaternion: Quaternion }): void {
    this.stage.rig.position.copy(position);
    this.stage.rig.quaternion.copy(quaternion);
    this.stage.rig.updateMatrixWorld(true);
    this.board.face_wearer();
  }

  private connect(pointer: Pointer): void {
    const { ray } = pointer;
    ray.addEventListener("connected", () => void this.begin_placing());
    ray.addEventListener("selectstart", () => this.select(pointer));
    ray.addEventListener("squeezestart", () => this.place_again());
    for (const end of ["selectend", "disconnected"] as const) {
      ray.addEventListener(end, () => this.grip?.pointer === pointer && this.release());
    }
  }

  private async begin_placing(): Promise<void> {
    const session = this.stage.renderer.xr.getSession();
    if (this.is_placing && session) await this.placement.begin(session);
  }

  private place_again(): void {
    if (this.grip) return;
    this.is_placing = this.stage.is_see_through;
    if (this.is_placing) void this.begin_placing();
    else this.place_before();
  }

  private select(pointer: Pointer): void {
    pointer.update();
    if (this.board.meets(pointer.caster, true) || this.place_at_ring()) return;
    this.take_hold(pointer);
  }

  private take_hold(pointer: Pointer): void {
    const frame = this.input.live_frame();
    if (!frame || this.grip) return;
    this.grip = {
      pointer,
      from: pointer.ray.getWorldPosition(new Vector3()),
      attitude: pointer.ray.getWorldQuaternion(new Quaternion()),
      handle: new Vector3(...frame.p_B_H_m),
      handle_attitude: new Quaternion(...frame.quaternion_B_H),
    };
    this.send_where();
  }

  private stop(): void {
    if (this.scene?.commands.includes("emergency_stop")) this.input.stop();
  }

  release(): void {
    if (!this.grip) return;
    this.grip = null;
    this.target = null;
    this.send_hand(false);
  }

  private send_where(): void {
    if (!this.grip) return;
    const { ray } = this.grip.pointer;
    const now = ray.getWorldPosition(new Vector3());
    const attitude = ray.getWorldQuaternion(new Quaternion());
    const { p_B, turn } = grip_target(this.grip, now, attitude);
    this.target = p_B;
    this.turn = turn;
    this.send_hand(true);
  }

  // Who holds the handle presses its lever.
  private send_hand(active: boolean): void {
    const p_B_m = this.target ?? this.input.live_frame()?.p_B_H_m ?? [0, 0, 0];
    const quaternion_B_H = active ? this.turn : null;
    this.input.send({ type: "hand", active, p_B_m, quaternion_B_H, press: active ? 1 : 0 });
  }
}

function to_user(frame: Frame): Vector3 {
  return new Vector3(0, 0, 1).applyQuaternion(new Quaternion(...frame.quaternion_B_H));
}
