// Headsets by WebXR: room and twin at true scale, a controller is the hand target. The trigger
// takes hold of the handle from wherever the controller is and moves it alike.

import {
  CapsuleGeometry,
  Mesh,
  MeshStandardMaterial,
  type PerspectiveCamera,
  Quaternion,
  Vector3,
  type XRTargetRaySpace,
} from "three";

import { icon } from "../icons";
import type { Frame, Hand, Quaternion as Turn, Vec3 } from "../messages";
import { element, make_button } from "../page";
import type { Stage } from "../scene/stage";
import { TARGET_COLOR } from "../theme";
import { grip_target, placed_rig } from "./grip";

const RESEND_MS = 33;

const SESSIONS = [
  ["immersive-vr", "VR", "Room and twin at true scale in a headset"],
  ["immersive-ar", "AR", "The twin in your own room, seen through a headset"],
] as const;

interface Grip {
  controller: XRTargetRaySpace;
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
  private readonly controllers: XRTargetRaySpace[];

  constructor(
    private readonly stage: Stage,
    private readonly frame: () => Frame | null,
    private readonly send: (hand: Hand) => void,
    private readonly on_problem: (text: string) => void,
  ) {
    const { xr } = stage.renderer;
    xr.enabled = true;
    xr.setReferenceSpaceType("local-floor");
    this.controllers = [0, 1].map((index) => xr.getController(index));
    for (const controller of this.controllers) this.connect(controller);
    xr.addEventListener("sessionend", () => this.exit());
    setInterval(() => this.send_where(), RESEND_MS);
    void this.offer();
  }

  get is_worn(): boolean {
    return this.stage.renderer.xr.isPresenting;
  }

  // A controller is seen: its trigger counts from now on.
  get is_tracked(): boolean {
    return this.is_worn && this.controllers.some((controller) => controller.visible);
  }

  get target_m(): Vec3 | null {
    return this.target;
  }

  // Buttons for what browser and headset can do.
  private async offer(): Promise<void> {
    for (const [mode, text, title] of SESSIONS) {
      const is_there = await navigator.xr?.isSessionSupported(mode).catch(() => false);
      if (!is_there) continue;
      const button = make_button(text, title, () => {
        this.enter(mode).catch((error: unknown) => this.on_problem(`${text}: ${String(error)}`));
      });
      button.id = `enter-${text.toLowerCase()}`;
      button.className = "with-icon";
      button.prepend(icon("headset"));
      element("view-tools").append(button);
    }
  }

  private async enter(mode: XRSessionMode): Promise<void> {
    const session = await navigator.xr!.requestSession(mode, { requiredFeatures: ["local-floor"] });
    const frame = this.frame();
    if (frame) {
      const floor_z = this.stage.floor_z_m;
      const place = placed_rig(new Vector3(...frame.p_B_H_m), to_user(frame), floor_z);
      this.stage.rig.position.copy(place.position);
      this.stage.rig.quaternion.copy(place.quaternion);
    }
    this.view_before = this.stage.camera.clone();
    this.stage.set_see_through(mode === "immersive-ar");
    await this.stage.renderer.xr.setSession(session);
  }

  private exit(): void {
    this.release();
    this.stage.set_see_through(false);
    this.stage.rig.position.set(0, 0, 0);
    this.stage.rig.quaternion.identity();
    const { camera } = this.stage;
    if (this.view_before) camera.copy(this.view_before);
    this.stage.reset_view();
  }

  private connect(controller: XRTargetRaySpace): void {
    const shape = new CapsuleGeometry(0.02, 0.09, 6, 16).rotateX(Math.PI / 2);
    controller.add(new Mesh(shape, new MeshStandardMaterial({ color: TARGET_COLOR })));
    controller.visible = false; // until three finds it
    this.stage.rig.add(controller);
    controller.addEventListener("selectstart", () => this.take_hold(controller));
    for (const end of ["selectend", "disconnected"] as const) {
      controller.addEventListener(end, () => this.grip?.controller === controller && this.release());
    }
  }

  private take_hold(controller: XRTargetRaySpace): void {
    const frame = this.frame();
    if (!frame || this.grip) return;
    this.grip = {
      controller,
      from: controller.getWorldPosition(new Vector3()),
      attitude: controller.getWorldQuaternion(new Quaternion()),
      handle: new Vector3(...frame.p_B_H_m),
      handle_attitude: new Quaternion(...frame.quaternion_B_H),
    };
    this.send_where();
  }

  release(): void {
    if (!this.grip) return;
    this.grip = null;
    this.target = null;
    this.send_hand(false);
  }

  private send_where(): void {
    if (!this.grip) return;
    const { controller } = this.grip;
    const now = controller.getWorldPosition(new Vector3());
    const attitude = controller.getWorldQuaternion(new Quaternion());
    const { p_B, turn } = grip_target(this.grip, now, attitude);
    this.target = p_B;
    this.turn = turn;
    this.send_hand(true);
  }

  // Who holds the handle presses its lever.
  private send_hand(active: boolean): void {
    const p_B_m = this.target ?? this.frame()?.p_B_H_m ?? [0, 0, 0];
    const quaternion_B_H = active ? this.turn : null;
    this.send({ type: "hand", active, p_B_m, quaternion_B_H, press: active ? 1 : 0 });
  }
}

function to_user(frame: Frame): Vector3 {
  return new Vector3(0, 0, 1).applyQuaternion(new Quaternion(...frame.quaternion_B_H));
}
