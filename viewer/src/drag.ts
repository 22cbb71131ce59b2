// The user's hand: pointer, keys and buttons become hand targets. Works with mouse, pen and touch.

import { Raycaster, Vector2, Vector3 } from "three";

import {
  type Ray,
  add,
  drag_normal,
  meet_plane,
  meet_vertical,
  subtract,
  within_reach,
} from "./drag_plane";
import type { Hand, Vec3 } from "./messages";
import type { Stage } from "./stage";

const GRAB_RADIUS_PX = 40;
const RESEND_MS = 33; // the program takes half a second of silence for a closed page
const REACH = 1.2; // m; a target never leads the handle by more

export class Drag {
  private pointer: number | null = null; // that holds the handle
  private target: Vec3 | null = null; // null = the hand is off the handle
  private anchor: Vec3 = [0, 0, 0]; // the plane of the drag goes through it
  private offset: Vec3 = [0, 0, 0]; // from where the pointer meets the plane to the target
  private last_pointer = new Vector2();
  private was_lifting = false;
  private is_pressing = false; // by key or button
  private is_shift = false;

  is_lifting = false; // by button
  presses_while_dragging = false;

  constructor(
    private readonly stage: Stage,
    private readonly handle: () => Vec3 | null,
    private readonly send: (hand: Hand) => void,
  ) {
    // on the parent and first, so that the orbit controls find themselves switched off
    const area = stage.canvas.parentElement!;
    area.addEventListener("pointerdown", (event) => this.grab(event), { capture: true });
    area.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"] as const) {
      area.addEventListener(name, (event) => this.release(event.pointerId), { capture: true });
    }
    addEventListener("blur", () => this.let_go());
    document.addEventListener("visibilitychange", () => document.hidden && this.let_go());
    addEventListener("pagehide", () => this.let_go());
    addEventListener("keydown", (event) => this.set_shift(event.shiftKey));
    addEventListener("keyup", (event) => this.set_shift(event.shiftKey));
    setInterval(() => this.target && this.tell(), RESEND_MS);
  }

  get is_dragging(): boolean {
    return this.pointer !== null;
  }

  get target_m(): Vec3 | null {
    return this.target;
  }

  get press(): number {
    return this.is_pressing || (this.is_dragging && this.presses_while_dragging) ? 1 : 0;
  }

  // Pressing alone takes hold of the handle where it is.
  set_pressing(is_pressing: boolean): void {
    if (this.is_pressing === is_pressing) return;
    this.is_pressing = is_pressing;
    if (!this.is_dragging) this.target = is_pressing ? this.handle() : null;
    this.tell();
  }

  private grab(event: PointerEvent): void {
    this.set_shift(event.shiftKey);
    const handle = this.handle();
    if (this.is_dragging) return event.stopPropagation(); // a second finger
    if (!handle || event.button !== 0 || !this.is_near(event, handle)) return;
    event.stopPropagation();
    this.pointer = event.pointerId;
    this.stage.controls.enabled = false;
    this.stage.canvas.setPointerCapture(event.pointerId);
    this.last_pointer.set(event.clientX, event.clientY);
    this.target = handle;
    this.restart();
    this.tell();
  }

  private move(event: PointerEvent): void {
    const handle = this.handle();
    if (event.pointerId !== this.pointer) {
      const can_grab = !this.is_dragging && handle && this.is_near(event, handle);
      this.stage.canvas.style.cursor = can_grab ? "grab" : "";
      return;
    }
    this.stage.canvas.style.cursor = "grabbing";
    this.last_pointer.set(event.clientX, event.clientY);
    if (this.lifts !== this.was_lifting) this.restart();
    const met = this.meet();
    if (met && handle) this.target = within_reach(add(met, this.offset), handle, REACH);
  }

  private release(pointer: number): void {
    if (pointer === this.pointer) this.let_go();
  }

  private let_go(): void {
    this.is_pressing = false;
    if (this.target === null) return;
    this.pointer = null;
    this.target = null;
    this.stage.controls.enabled = true;
    this.stage.canvas.style.cursor = "";
    this.tell();
  }

  private get lifts(): boolean {
    return this.is_shift || this.is_lifting;
  }

  private set_shift(is_shift: boolean): void {
    this.is_shift = is_shift;
  }

  // From now on the target moves with the pointer, starting where it is.
  private restart(): void {
    this.was_lifting = this.lifts;
    this.anchor = this.target ?? [0, 0, 0];
    const met = this.meet();
    this.offset = met ? subtract(this.anchor, met) : [0, 0, 0];
  }

  private meet(): Vec3 | null {
    const ray = this.ray();
    if (this.lifts) return meet_vertical(ray, this.anchor);
    const view = this.stage.camera.getWorldDirection(new Vector3()).toArray();
    return meet_plane(ray, this.anchor, drag_normal(view));
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

  private tell(): void {
    const p_B_m = this.target ?? this.handle() ?? [0, 0, 0];
    this.send({ type: "hand", active: this.target !== null, p_B_m, press: this.press });
  }
}
