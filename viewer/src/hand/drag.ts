// The user's hand: pointer, keys and buttons become hand targets. Works with mouse, pen and touch.

import { Raycaster, Vector2, Vector3 } from "three";

import type { Frame, Hand, Quaternion, Vec3 } from "../messages";
import type { Cameras } from "../scene/cameras";
import type { Stage } from "../scene/stage";
import {
  type Ray,
  add,
  drag_normal,
  meet_axis,
  meet_plane,
  subtract,
  within_reach,
} from "./drag_plane";
import { turned } from "./turn";

const GRAB_RADIUS_PX = 40;
const RESEND_MS = 33; // the program takes half a second of silence for a closed page
const SPIN_PX = 8; // that a notch of the wheel or a key turns by: 3.7 degrees
const REACH = 1.2; // m; a target never leads the handle by more

// What a drag does: moves in the plane, along an axis of B, or turns the handle.
export type DragMode = "plane" | "x" | "y" | "z" | "turn";

const AXES: Record<"x" | "y" | "z", Vec3> = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

export class Drag {
  chosen_mode: DragMode = "plane"; // by button
  key_mode: DragMode | null = null; // by a key that is held
  presses_while_dragging = false;
  can_hold = true; // false: it is a recording
  private pointer: number | null = null; // that holds the handle
  private readonly others = new Set<number>(); // pointers that move the camera
  private target: Vec3 | null = null; // null = the hand is off the handle
  private turn: Quaternion | null = null; // wanted attitude, null = as the hand likes
  private anchor: Vec3 = [0, 0, 0]; // plane or axis of the drag go through it
  private offset: Vec3 = [0, 0, 0]; // from where the pointer meets the plane to the target
  private turn_start: Quaternion = [0, 0, 0, 1];
  private last_pointer = new Vector2();
  private turn_pointer = new Vector2();
  private last_mode: DragMode = "plane";
  private is_pressing = false; // by key or button

  constructor(
    private readonly stage: Stage,
    private readonly cameras: Cameras,
    private readonly frame: () => Frame | null,
    private readonly send: (hand: Hand) => void,
  ) {
    // on the parent and first, so that the orbit controls find themselves switched off
    const area = stage.canvas.parentElement!;
    area.addEventListener("pointerdown", (event) => this.grab(event), { capture: true });
    area.addEventListener("pointermove", (event) => this.move(event));
    area.addEventListener("wheel", (event) => this.take_wheel(event), { passive: false });
    for (const name of ["pointerup", "pointercancel"] as const) {
      addEventListener(name, (event) => this.end_pointer(event.pointerId), { capture: true });
    }
    addEventListener("blur", () => {
      this.key_mode = null; // the key is released elsewhere
      this.release();
    });
    document.addEventListener("visibilitychange", () => document.hidden && this.release());
    addEventListener("pagehide", () => this.release());
    setInterval(() => this.target && this.send_hand(), RESEND_MS);
  }

  get is_dragging(): boolean {
    return this.pointer !== null;
  }

  get target_m(): Vec3 | null {
    return this.target;
  }

  get mode(): DragMode {
    return this.key_mode ?? this.chosen_mode;
  }

  // Along which the target moves, null = in a plane or not at all.
  get axis(): Vec3 | null {
    const { mode } = this;
    return this.is_dragging && mode !== "plane" && mode !== "turn" ? AXES[mode] : null;
  }

  get press(): number {
    return this.is_pressing || (this.is_dragging && this.presses_while_dragging) ? 1 : 0;
  }

  // Pressing alone takes hold of the handle where it is.
  set_pressing(is_pressing: boolean): void {
    if (this.is_pressing === is_pressing || !this.can_hold) return;
    this.is_pressing = is_pressing;
    if (!this.is_dragging) this.target = is_pressing ? this.handle : null;
    this.send_hand();
  }

  // Turns the handle that is dragged about the vertical, whatever else the drag does; +1: to the left.
  spin(notches: number): void {
    const start = this.turn ?? this.frame()?.quaternion_B_H;
    if (!this.is_dragging || !start) return;
    this.turn = turned(start, SPIN_PX * notches, 0, this.view);
    if (this.mode === "turn") this.restart();
    this.send_hand();
  }

  private take_wheel(event: WheelEvent): void {
    if (!this.is_dragging) return;
    event.preventDefault();
    this.spin(event.deltaY < 0 ? 1 : -1);
  }

  release(): void {
    this.is_pressing = false;
    if (this.target === null) return;
    this.pointer = null;
    this.target = null;
    this.turn = null;
    this.cameras.controls.enabled = this.cameras.current !== "first person";
    this.stage.canvas.style.cursor = "";
    this.send_hand();
  }

  private get handle(): Vec3 | null {
    return this.frame()?.p_B_H_m ?? null;
  }

  private grab(event: PointerEvent): void {
    const handle = this.handle;
    if (this.is_dragging) return event.stopPropagation(); // a second finger
    const is_free = handle !== null && this.can_hold && this.others.size === 0;
    if (!is_free || event.button !== 0 || !this.is_near(event, handle)) {
      this.others.add(event.pointerId); // also the second finger of two that pinch
      return;
    }
    event.stopPropagation();
    this.pointer = event.pointerId;
    this.cameras.controls.enabled = false;
    this.stage.canvas.setPointerCapture(event.pointerId);
    this.last_pointer.set(event.clientX, event.clientY);
    this.target = handle;
    this.restart();
    this.send_hand();
  }

  private move(event: PointerEvent): void {
    const handle = this.handle;
    if (event.pointerId !== this.pointer) {
      const can_grab = this.can_hold && !this.is_dragging && handle && this.is_near(event, handle);
      this.stage.canvas.style.cursor = can_grab ? "grab" : "";
      return;
    }
    this.stage.canvas.style.cursor = "grabbing";
    this.last_pointer.set(event.clientX, event.clientY);
    if (this.mode !== this.last_mode) this.restart();
    if (this.mode === "turn") {
      const move = this.last_pointer.clone().sub(this.turn_pointer);
      this.turn = turned(this.turn_start, move.x, move.y, this.view);
      return;
    }
    const met = this.meet();
    if (met && handle) this.target = within_reach(add(met, this.offset), handle, REACH);
  }

  private end_pointer(pointer: number): void {
    this.others.delete(pointer);
    if (pointer === this.pointer) this.release();
  }

  // From now on the target moves with the pointer, starting where it is.
  private restart(): void {
    this.last_mode = this.mode;
    this.anchor = this.target ?? [0, 0, 0];
    this.turn_start = this.turn ?? this.frame()?.quaternion_B_H ?? [0, 0, 0, 1];
    this.turn_pointer.copy(this.last_pointer);
    const met = this.meet();
    this.offset = met ? subtract(this.anchor, met) : [0, 0, 0];
  }

  private meet(): Vec3 | null {
    if (this.mode === "turn") return null;
    if (this.axis) return meet_axis(this.ray(), this.anchor, this.axis);
    return meet_plane(this.ray(), this.anchor, drag_normal(this.view));
  }

  private get view(): Vec3 {
    return this.stage.camera.getWorldDirection(new Vector3()).toArray();
  }

  private ray(): Ray {
    const area = this.stage.canvas.getBoundingClientRect();
    const caster = new Raycaster();
    const x = (2 * (this.last_pointer.x - area.left)) / area.width - 1;
    const y = 1 - (2 * (this.last_pointer.y - area.top)) / area.height;
    caster.setFromCamera(new Vector2(x, y), this.stage.camera);
    return { origin: caster.ray.origin.toArray(), direction: caster.ray.direction.toArray() };
  }

  private is_near(event: PointerEvent, handle: Vec3): boolean {
    const { x, y } = this.stage.on_screen(handle);
    return Math.hypot(event.clientX - x, event.clientY - y) <= GRAB_RADIUS_PX;
  }

  private send_hand(): void {
    const p_B_m = this.target ?? this.handle ?? [0, 0, 0];
    const active = this.target !== null;
    this.send({ type: "hand", active, p_B_m, quaternion_B_H: this.turn, press: this.press });
  }
}
