// The picture in space: WebGL, cameras, layers, headset.

import { CameraView } from "../hand/camera_view";
import type { Pixel } from "../hand/hand_view";
import type { Event, Frame, Scene, Vec3 } from "../messages";
import { Legend } from "../guide/legend";
import { element } from "../page";
import { asked_view } from "../scene/asked_view";
import { Cameras } from "../scene/cameras";
import { FirstView } from "../scene/first_view";
import { Layers } from "../scene/layers";
import { reached_until } from "../scene/reached";
import { Stage } from "../scene/stage";
import { World } from "../scene/world";
import { current_theme, on_theme_change } from "../theme";
import { Headset } from "../xr/headset";
import { CameraTools } from "./camera_tools";
import type { Picture, PictureInput } from "./picture";

export class SpacePicture implements Picture {
  readonly view: CameraView;
  readonly has_cameras = true;
  private readonly stage = new Stage(element("stage"));
  private readonly cameras = new Cameras(this.stage.camera, this.stage.canvas);
  private readonly layers = new Layers(() => {
    this.world?.apply_layers();
    this.legend.apply_layers();
  });
  private readonly legend = new Legend(this.layers);
  private readonly tools = new CameraTools(this.cameras, this.layers, (text) => this.input.report("view", text));
  private readonly headset: Headset;
  private readonly events: Event[] = []; // also before their world was there
  private world: World | null = null;
  private device = ""; // that has been seen last
  private has_looked = false; // the first view has been chosen

  constructor(private readonly input: PictureInput) {
    this.view = new CameraView(this.stage, this.cameras);
    this.headset = new Headset(this.stage, input);
    this.stage.canvas.setAttribute("role", "img");
    this.stage.canvas.setAttribute("aria-label", "Device, twin, handle and force in space");
    on_theme_change(() => this.world?.paint(current_theme()));
    this.stage.on_resize = () => this.cameras.resize();
  }

  get scene(): Scene | null {
    return this.world?.scene ?? null;
  }

  get target_m(): Vec3 | null {
    return this.headset.target_m;
  }

  get is_hand_tracked(): boolean {
    return this.headset.is_tracked;
  }

  get is_worn(): boolean {
    return this.headset.is_worn;
  }

  async load(scene: Scene, is_current: () => boolean): Promise<void> {
    this.stage.load(scene.box, scene.floor_z_m, scene.twin_base_moves);
    if (this.device !== scene.device.name) this.frame_device(scene);
    const world = await World.load(scene, this.stage, this.layers).catch((error: unknown) => {
      this.input.report("world", error instanceof Error ? error.message : String(error));
      return null;
    });
    if (!is_current()) return world?.dispose();
    if (!world) return;
    this.world?.dispose();
    this.world = world;
    world.paint(current_theme());
    this.stage.scene.add(world.root);
  }

  note(frame: Frame): void {
    this.world?.note(frame);
  }

  happened(event: Event): void {
    this.events.push(event);
  }

  forget_events(): void {
    this.events.length = 0;
  }

  show(frame: Frame, target: Vec3 | null, axis: Vec3 | null): void {
    if (!this.world) return;
    if (!this.has_looked) this.look(this.world, frame);
    this.legend.show({
      ghost: frame.ghost !== null,
      remote: frame.teleoperation !== null,
      base: this.world.scene.twin_base_moves,
    });
    this.world.show(frame, target, axis, reached_until(this.world.scene, this.events, frame.time_s));
    this.headset.update(this.world.scene, frame);
    const is_first_person = this.cameras.current === "first person" || this.is_worn;
    this.world.person.hide_body(is_first_person);
    if (!this.is_worn) this.cameras.update(frame.p_B_H_m, this.world.person.eyes);
  }

  private look(world: World, frame: Frame): void {
    this.has_looked = true;
    const asked = asked_view();
    const first = new FirstView(world.sights(frame));
    const is_place = asked !== null && typeof asked === "object";
    this.cameras.begin_with(() => (is_place ? asked : first.sight(this.stage.camera)));
  }

  release(): void {
    this.headset.release();
  }

  on_screen(p_B: Vec3): Pixel {
    return this.stage.on_screen(p_B);
  }

  run(prepare: (now_ms: number) => void): void {
    this.stage.run(prepare);
  }

  draw(): void {
    this.stage.draw();
  }

  // From where a person who drags the handle to places on the floor sees them: from above.
  private frame_device(scene: Scene): void {
    this.device = scene.device.name;
    this.cameras.frame(scene.box);
    this.has_looked = false;
    const is_walked = document.body.dataset.show === "hand" && scene.checkpoints.length > 0;
    const asked = asked_view();
    this.tools.begin(typeof asked === "string" ? asked : is_walked ? "top" : null);
  }
}
