// The picture where there is no WebGL: from the side and from above, on plain canvases. The hand is
// dragged in either view.

import type { Ray } from "../hand/drag_plane";
import type { HandView, Pixel } from "../hand/hand_view";
import type { Event, Frame, Scene, Vec3 } from "../messages";
import { element, make } from "../page";
import { reached_until } from "../scene/reached";
import { on_theme_change } from "../theme";
import { Bodies } from "./bodies";
import { FlatView } from "./flat_view";
import type { Picture, PictureInput } from "./picture";
import { type Area, type Facing, SIDE, TOP, area_of } from "./projection";

const HELP =
  "STOP, panel, plots and the hand work as always: drag the ring in either view. The picture in space needs " +
  "WebGL 2: switch graphics acceleration on in the browser's settings.";
const AIR_M = 0.35; // around what is shown
const REACH_M = 0.6; // around the handle

const FACINGS = [SIDE, TOP];

export class FlatPicture implements Picture, HandView {
  readonly area = element("stage");
  readonly view = this;
  readonly target_m = null;
  readonly is_hand_tracked = false;
  readonly is_worn = false;
  readonly has_cameras = false;
  private readonly views: FlatView[];
  private held: FlatView; // in which the hand is, or was last
  private bodies: Bodies | null = null;
  private has_looked = false;
  private readonly events: Event[] = [];

  // `reason`: why there is no picture in space.
  constructor(
    reason: string,
    private readonly input: PictureInput,
  ) {
    const empty: Area = { low: [-1, -1], high: [1, 1] };
    this.views = FACINGS.map((facing) => new FlatView(facing, empty));
    this.held = this.views[1]!;
    const note = make("p", "flat-note", reason, " ", make("span", "flat-help", HELP));
    note.id = "no-space";
    this.area.classList.add("is-flat");
    this.area.append(note, ...this.views.map(({ part }) => part));
    on_theme_change(() => this.views.forEach((view) => view.repaint()));
  }

  get scene(): Scene | null {
    return this.bodies?.scene ?? null;
  }

  async load(scene: Scene, is_current: () => boolean): Promise<void> {
    const bodies = await Bodies.load(scene).catch((error: unknown) => {
      this.input.report("world", error instanceof Error ? error.message : String(error));
      return null;
    });
    if (!is_current() || !bodies) return;
    this.bodies = bodies;
    this.has_looked = false;
  }

  note(): void {}

  happened(event: Event): void {
    this.events.push(event);
  }

  forget_events(): void {
    this.events.length = 0;
  }

  show(frame: Frame, target: Vec3 | null): void {
    if (!this.bodies) return;
    const { scene } = this.bodies;
    this.bodies.pose(frame);
    const bodies = this.bodies.list(frame.contact);
    if (!this.has_looked) this.look(frame);
    const reached = reached_until(scene, this.events, frame.time_s);
    for (const view of this.views) view.draw({ scene, frame, bodies, target, reached });
  }

  release(): void {
    this.show_cursor("");
  }

  on_screen(p_B: Vec3): Pixel {
    return this.held.on_screen(p_B);
  }

  run(prepare: (now_ms: number) => void): void {
    const draw = (now_ms: number): void => {
      requestAnimationFrame(draw);
      prepare(now_ms);
    };
    requestAnimationFrame(draw);
  }

  draw(): void {} // `show` has drawn it

  is_near(pixel: Pixel, p_B: Vec3): boolean {
    const found = this.views.find((view) => view.is_near(pixel, p_B));
    if (found) this.held = found;
    return found !== undefined;
  }

  ray(pixel: Pixel): Ray {
    return { origin: this.held.origin_of(pixel), direction: this.held.into() };
  }

  direction(): Vec3 {
    return this.held.into();
  }

  capture(pointer: number): void {
    this.held.canvas.setPointerCapture(pointer);
  }

  show_cursor(cursor: "" | "grab" | "grabbing"): void {
    for (const { canvas } of this.views) canvas.style.cursor = cursor;
  }

  // So that device, twin and where the hand may go are seen: the box, but not more than its reach.
  private look(frame: Frame): void {
    const { scene } = this.bodies!;
    const moving = this.bodies!.list(null).filter(({ kind }) => kind !== "wall");
    const around = (sign: number): Vec3 => frame.p_B_H_m.map((x) => x + sign * REACH_M) as Vec3;
    const points = [...moving.flatMap((body) => body.points), around(1), around(-1)];
    points.push([frame.p_B_H_m[0], frame.p_B_H_m[1], scene.floor_z_m]);
    const areas: [FlatView, Facing][] = this.views.map((view, i) => [view, FACINGS[i]!]);
    for (const [view, facing] of areas) view.look_at(area_of(facing, points, AIR_M));
    this.has_looked = true;
  }
}
