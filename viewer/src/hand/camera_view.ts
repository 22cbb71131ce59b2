// Dragging in the 3-D picture, along the rays of its camera.

import { Raycaster, Vector2, Vector3 } from "three";

import type { Vec3 } from "../messages";
import type { Cameras } from "../scene/cameras";
import type { Stage } from "../scene/stage";
import type { Ray } from "./drag_plane";
import { type HandView, type Pixel, is_within_grab } from "./hand_view";

export class CameraView implements HandView {
  readonly area: HTMLElement;

  constructor(
    private readonly stage: Stage,
    private readonly cameras: Cameras,
  ) {
    // the parent gets events first, so that the orbit controls find themselves switched off
    this.area = stage.canvas.parentElement!;
  }

  is_near(pixel: Pixel, p_B: Vec3): boolean {
    return is_within_grab(pixel, this.stage.on_screen(p_B));
  }

  ray(pixel: Pixel): Ray {
    const area = this.stage.canvas.getBoundingClientRect();
    const x = (2 * (pixel.x - area.left)) / area.width - 1;
    const y = 1 - (2 * (pixel.y - area.top)) / area.height;
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2(x, y), this.stage.camera);
    return { origin: caster.ray.origin.toArray(), direction: caster.ray.direction.toArray() };
  }

  direction(): Vec3 {
    return this.stage.camera.getWorldDirection(new Vector3()).toArray();
  }

  capture(pointer: number): void {
    this.cameras.controls.enabled = false;
    this.stage.canvas.setPointerCapture(pointer);
  }

  release(): void {
    this.cameras.controls.enabled = this.cameras.current !== "first person";
    this.show_cursor("");
  }

  show_cursor(cursor: "" | "grab" | "grabbing"): void {
    this.stage.canvas.style.cursor = cursor;
  }
}
