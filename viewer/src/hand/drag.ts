// The user's hand: pointer, keys and buttons become hand targets. Works with mouse, pen and touch.

import type { Frame, Hand, Quaternion, Vec3 } from "../messages";
import { add, drag_normal, meet_axis, meet_plane, subtract, within_reach } from "./drag_plane";
import type { HandView, Pixel } from "./hand_view";
import { turned } from "./turn";

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
  can_hold = true; // false: it is a recording, or another page has the hand
  on_refused = (): void => {}; // the hand was reached for and cannot be held
  private pointer: number | null = null; // that holds the handle
  private readonly others = new Set<number>(); // pointers that move the camera
  private target: Vec3 | null = null; // null = the hand is off the handle
  private turn: Quaternion | null = null; // wanted attitude, null = as the hand likes
  private anchor: Vec3 = [0, 0, 0]; // plane or axis of the drag go through it
  private offset: Vec3 = [0, 0, 0]; // from where the pointer meets the plane to the target
  private turn_start: Quaternion = [0, 0, 0, 1];
  private last_pointer: Pixel = { x: 0, y: 0 };
  private turn_pointer: Pixel = { x: 0, y: 0 };
  private push: (() => Vec3) | null = null; // by keys: from the handle to the target
  private last_mode: DragMode = "plane";
  private is_pressing = false; // by key or button

  constructor(
    private readonly view: HandView,
    private readonly frame: () => Frame | null,
    private readonly send: (hand: Hand) => void,
  ) {
    const { area } = view;
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
    setInterval(() => this.resend(), RESEND_MS);
  }

  get is_dragging(): boolean {
    return this.pointer !== null;
  }

  get is_pushing(): boolean {
    return this.push !== null;
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
    const is_moving = this.is_dragging || this.is_pushing;
    return this.is_pressing || (is_moving && this.presses_while_dragging) ? 1 : 0;
  }

  // Pressing alone takes hold of the handle where it is.
  set_pressing(is_pressing: boolean): void {
    if (this.is_pressing === is_pressing) return;
    if (!this.can_hold) return is_pressing ? this.on_refused() : undefined;
    this.is_pressing = is_pressing;
    if (!this.is_dragging && !this.is_pushing) this.target = is_pressing ? this.handle : null;
    this.send_hand();
  }

  // Keys push the handle towards `offset` from where it is; null: the last key is released. A
  // pointer that drags goes first.
  set_push(offset: (() => Vec3) | null): void {
    if (this.is_dragging) return;
    if (offset !== null && !this.can_hold) return this.on_refused();
    const was_pushing = this.is_pushing;
    this.push = offset;
    if (offset !== null) return this.resend();
    if (!was_pushing) return;
    this.target = this.is_pressing ? this.handle : null;
    this.send_hand();
  }

  // Turns the handle that is dragged about the vertical, whatever else the drag does; +1: to the left.
  spin(notches: number): void {
    const start = this.turn ?? this.frame()?.quaternion_B_H;
    if (!this.is_dragging || !start) return;
    this.turn = turned(start, SPIN_PX * notches, 0, this.view.direction());
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
    this.push = null;
    if (this.target === null) return;
    this.pointer = null;
    this.target = null;
    this.turn = null;
    this.view.release();
    this.send_hand();
  }

  private get handle(): Vec3 | null {
    return this.frame()?.p_B_H_m ?? null;
  }

  private grab(event: PointerEvent): void {
    const handle = this.handle;
    if (this.is_dragging) return event.stopPropagation(); // a second finger
    const is_meant =
      handle !== null && this.others.size === 0 && event.button === 0 && this.is_near(event, handle);
    if (is_meant && !this.can_hold) this.on_refused();
    if (!is_meant || !this.can_hold) {
      this.others.add(event.pointerId); // also the second finger of two that pinch
      return;
    }
    event.stopPropagation();
    this.push = null;
    this.pointer = event.pointerId;
    this.view.capture(event.pointerId);
    this.last_pointer = pixel_of(event);
    this.target = handle;
    this.restart();
    this.send_hand();
  }

  private move(event: PointerEvent): void {
    const handle = this.handle;
    if (event.pointerId !== this.pointer) {
      const can_grab = this.can_hold && !this.is_dragging && handle && this.is_near(event, handle);
      this.view.show_cursor(can_grab ? "grab" : "");
      return;
    }
    this.view.show_cursor("grabbing");
    this.last_pointer = pixel_of(event);
    if (this.mode !== this.last_mode) this.restart();
    if (this.mode === "turn") {
      const { x, y } = this.turn_pointer;
      const [right, down] = [this.last_pointer.x - x, this.last_pointer.y - y];
      this.turn = turned(this.turn_start, right, down, this.view.direction());
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
    this.turn_pointer = this.last_pointer;
    const met = this.meet();
    this.offset = met ? subtract(this.anchor, met) : [0, 0, 0];
  }

  private meet(): Vec3 | null {
    if (this.mode === "turn") return null;
    const ray = this.view.ray(this.last_pointer);
    if (this.axis) return meet_axis(ray, this.anchor, this.axis);
    return meet_plane(ray, this.anchor, drag_normal(this.view.direction()));
  }

  private is_near(event: PointerEvent, handle: Vec3): boolean {
    return this.view.is_near(pixel_of(event), handle);
  }

  private resend(): void {
    const { handle } = this;
    if (this.push && handle) this.target = add(handle, this.push());
    if (this.target) this.send_hand();
  }

  private send_hand(): void {
    const p_B_m = this.target ?? this.handle ?? [0, 0, 0];
    const active = this.target !== null;
    this.send({ type: "hand", active, p_B_m, quaternion_B_H: this.turn, press: this.press });
  }
}

function pixel_of({ clientX, clientY }: PointerEvent): Pixel {
  return { x: clientX, y: clientY };
}
