// What dragging needs of the picture in which the hand is dragged.

import type { Vec3 } from "../messages";
import type { Ray } from "./drag_plane";

// In the window, CSS pixels.
export interface Pixel {
  x: number;
  y: number;
}

export interface HandView {
  readonly area: HTMLElement; // gets the pointer's events
  is_near(pixel: Pixel, p_B: Vec3): boolean; // near enough to take what is at p_B
  ray(pixel: Pixel): Ray;
  direction(): Vec3; // into the picture
  capture(pointer: number): void; // of a drag that begins: the view stays as it is
  release(): void;
  show_cursor(cursor: "" | "grab" | "grabbing"): void;
}

const GRAB_RADIUS_PX = 40;

export function is_within_grab(pixel: Pixel, handle: Pixel): boolean {
  return Math.hypot(pixel.x - handle.x, pixel.y - handle.y) <= GRAB_RADIUS_PX;
}
