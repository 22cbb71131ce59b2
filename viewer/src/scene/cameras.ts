// Where one looks from: orbit, follow the handle, from above, through the eyes of the person.

import { MOUSE, type PerspectiveCamera, TOUCH, Vector3 } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import type { SceneBox, Vec3 } from "../messages";
import type { Sight } from "./first_view";

export type View = "orbit" | "follow" | "top" | "first person";
export const VIEWS: View[] = ["orbit", "follow", "top", "first person"];

const EYE_ABOVE = 1.25; // m, above the middle of the box
const FOLLOW_SHARE = 0.08; // of the way per picture
const SMALLEST_AWAY = 2; // m, of the first view from the box
const NEAR = 0.05; // m
const CUT_ABOVE = 0.45; // m above the box: what hangs higher is cut off in the view from above
const FIELD_OF_VIEW = { wide: 40, tall: 56, first_person: 72 }; // degrees

export interface Eyes {
  p_B: Vector3;
  towards_B: Vector3;
}

export class Cameras {
  readonly controls: OrbitControls;
  private view: View = "orbit";
  private low = new Vector3();
  private high = new Vector3();
  private first_sight: (() => Sight) | null = null; // null: from beside the box
  private is_moved = false; // away from the first view

  constructor(
    private readonly camera: PerspectiveCamera,
    canvas: HTMLCanvasElement,
  ) {
    this.controls = new OrbitControls(camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.maxPolarAngle = 0.53 * Math.PI; // not from below the floor
    this.controls.minDistance = 0.4;
    this.controls.maxDistance = 14;
    this.controls.addEventListener("start", () => (this.is_moved = true));
  }

  // Where one looks from now, and at what.
  get sight(): Sight {
    return { from: this.camera.position, at: this.controls.target };
  }

  get current(): View {
    return this.view;
  }

  // Looks into the cell through its open side, from beside and above the person.
  frame(box: SceneBox): void {
    this.first_sight = null;
    this.low.set(...box.min_m);
    this.high.set(...box.max_m);
    this.choose("orbit");
  }

  // Begins with a view of all that matters, instead of one into the box. It is fitted again when
  // the size of the picture changes, until the user moves the camera.
  begin_with(sight: () => Sight): void {
    this.first_sight = sight;
    this.choose(this.view);
  }

  choose(view: View): void {
    this.view = view;
    this.is_moved = false;
    this.camera.up.set(0, 0, 1);
    this.camera.near = NEAR;
    this.controls.enabled = view !== "first person";
    this.controls.enableRotate = view !== "top";
    this.controls.mouseButtons.LEFT = view === "top" ? MOUSE.PAN : MOUSE.ROTATE;
    this.controls.touches.ONE = view === "top" ? TOUCH.PAN : TOUCH.ROTATE;
    const center = new Vector3().addVectors(this.low, this.high).multiplyScalar(0.5);
    const size = new Vector3().subVectors(this.high, this.low);
    if (view === "top") {
      const height = 1.25 * Math.max(size.x, size.y) + 1.2;
      this.camera.near = height - 0.5 * size.z - CUT_ABOVE;
      this.controls.target.copy(center);
      this.camera.position.set(center.x, center.y - 0.01, center.z + height);
    } else if (view !== "first person") {
      const away = Math.max(SMALLEST_AWAY, 0.62 * size.y);
      this.controls.target.copy(center);
      this.camera.position.set(center.x + 0.6 * size.x, this.low.y - away, center.z + EYE_ABOVE);
    }
    this.resize();
    this.controls.update();
  }

  resize(): void {
    const { wide, tall, first_person } = FIELD_OF_VIEW;
    const all = this.camera.aspect > 1 ? wide : tall;
    this.camera.fov = this.view === "first person" ? first_person : all;
    this.camera.updateProjectionMatrix();
    if (!this.is_moved && this.controls.enabled) this.take_first_sight(); // not during a drag
  }

  private take_first_sight(): void {
    if (!this.first_sight || this.view === "top") return;
    const { from, at } = this.first_sight();
    this.camera.position.copy(from);
    this.controls.target.copy(at);
  }

  update(handle_B: Vec3, eyes: Eyes): void {
    if (this.view === "first person") {
      this.camera.position.copy(eyes.p_B);
      this.camera.lookAt(eyes.towards_B);
      return;
    }
    if (this.view === "follow") {
      this.is_moved = true;
      const step = new Vector3(...handle_B).sub(this.controls.target).multiplyScalar(FOLLOW_SHARE);
      this.controls.target.add(step);
      this.camera.position.add(step);
    }
    this.controls.update();
  }
}
