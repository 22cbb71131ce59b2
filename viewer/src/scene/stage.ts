// The empty stage: light, floor, box of the handle, and drawing at the screen's pace.
// The world is the base frame B, z up; in a headset `rig` turns its y-up space into B.

import {
  Box3,
  Box3Helper,
  CircleGeometry,
  Color,
  DirectionalLight,
  Fog,
  Group,
  HemisphereLight,
  LineBasicMaterial,
  Mesh,
  MeshStandardMaterial,
  NeutralToneMapping,
  type Object3D,
  PCFShadowMap,
  PerspectiveCamera,
  PMREMGenerator,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";
import { RoomEnvironment } from "three/examples/jsm/environments/RoomEnvironment.js";

import { page_options } from "../data/token";
import type { SceneBox, Vec3 } from "../messages";
import { current_theme, on_theme_change } from "../theme";
import { ContactShadow } from "./contact_shadow";
import { dispose_of } from "./dispose";
import { Grid } from "./grid";
import { Quality, type Wish } from "./quality";

export interface Pixel {
  x: number;
  y: number;
}

const MORE_SKY = 2.5; // when nothing reflects the room

export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera();
  readonly rig = new Group(); // of the camera in a headset
  readonly renderer: WebGLRenderer;
  readonly canvas: HTMLCanvasElement;
  private readonly quality = new Quality(wished_quality());
  readonly box_view = new Group();
  floor_z_m = 0;
  on_resize = (): void => this.camera.updateProjectionMatrix();
  private readonly sun = new DirectionalLight();
  private readonly sky = new HemisphereLight();
  private readonly floor = new Mesh(
    new CircleGeometry(30, 64),
    new MeshStandardMaterial({ roughness: 0.95 }),
  );
  private readonly grid = new Grid();
  private readonly contact = new ContactShadow();
  private readonly box_lines = new LineBasicMaterial({ transparent: true, opacity: 0.55 });
  is_see_through = false; // a headset shows the real room

  constructor(private readonly parent: HTMLElement) {
    this.renderer = new WebGLRenderer({
      antialias: this.quality.is_fine,
      alpha: true, // the room behind shows through in augmented reality
      powerPreference: "high-performance",
    });
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    parent.append(this.canvas);
    this.camera.up.set(0, 0, 1);
    this.rig.add(this.camera);

    this.floor.receiveShadow = true;
    this.add_sun();
    if (this.quality.is_fine) this.reflect_room();
    this.scene.add(this.rig, this.sky, this.floor, this.grid.mesh, this.contact.group);
    this.scene.add(this.box_view);
    this.paint();
    on_theme_change(() => this.paint());
    new ResizeObserver(() => {
      this.resize(); // empties the canvas
      if (!this.renderer.xr.isPresenting) this.renderer.render(this.scene, this.camera);
    }).observe(parent);
    this.resize();
  }

  // Draws before every repaint of the screen or headset, after `prepare`.
  run(prepare: (now_ms: number) => void): void {
    this.renderer.setAnimationLoop((now_ms: number) => {
      const is_in_headset = this.renderer.xr.isPresenting;
      if (!is_in_headset && this.quality.observe(now_ms)) this.resize();
      try {
        prepare(now_ms);
      } catch (error) {
        reportError(error); // three would never draw again
      }
      this.draw();
    });
  }

  draw(): void {
    if (!this.renderer.xr.isPresenting) this.contact.update(this.renderer, this.scene);
    this.renderer.render(this.scene, this.camera);
  }

  // What `root` shows stands on the floor.
  ground(root: Object3D): void {
    this.contact.add(root);
  }

  // `is_open`: what dips into the floor is seen.
  load(box: SceneBox, floor_z_m: number, is_open: boolean): void {
    this.floor.material.depthWrite = !is_open;
    this.floor.renderOrder = is_open ? -1 : 0; // before all that is drawn over it
    this.floor_z_m = this.floor.position.z = floor_z_m;
    this.grid.mesh.position.z = floor_z_m + 0.002;
    const lines = new Box3Helper(new Box3(new Vector3(...box.min_m), new Vector3(...box.max_m)));
    lines.material = this.box_lines;
    dispose_of(this.box_view);
    this.box_view.clear();
    this.box_view.add(lines);
    const [x, y] = [0, 1].map((axis) => 0.5 * (box.min_m[axis]! + box.max_m[axis]!));
    this.sun.target.position.set(x!, y!, floor_z_m);
    this.contact.group.position.set(x!, y!, floor_z_m);
    this.sun.position.set(x! + 1.8, y! - 2.6, floor_z_m + 9);
  }

  on_screen(p_B: Vec3): Pixel {
    const seen = new Vector3(...p_B).project(this.camera);
    const area = this.canvas.getBoundingClientRect();
    return {
      x: area.left + 0.5 * (1 + seen.x) * area.width,
      y: area.top + 0.5 * (1 - seen.y) * area.height,
    };
  }

  // After a headset, which has its own view.
  reset_view(): void {
    this.resize();
  }

  // Without background and floor, for a headset that shows the real room.
  set_see_through(is_see_through: boolean): void {
    this.is_see_through = is_see_through;
    this.floor.visible = this.grid.mesh.visible = !is_see_through;
    this.paint();
  }

  private add_sun(): void {
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.radius = 5;
    this.sun.shadow.intensity = 0.6;
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.02;
    const view = this.sun.shadow.camera;
    Object.assign(view, { left: -4.5, right: 4.5, top: 4.5, bottom: -4.5, near: 1, far: 14 });
    this.scene.add(this.sun, this.sun.target);
  }

  private reflect_room(): void {
    const generator = new PMREMGenerator(this.renderer);
    this.scene.environment = generator.fromScene(new RoomEnvironment(), 0.04).texture;
    this.scene.environmentRotation.x = Math.PI / 2; // its lamps hang above, along z
    generator.dispose();
  }

  private paint(): void {
    const theme = current_theme();
    this.scene.background = this.is_see_through ? null : new Color(theme.background);
    this.scene.fog = this.is_see_through ? null : new Fog(theme.background, 8, 19);
    this.scene.environmentIntensity = theme.reflections;
    this.renderer.toneMappingExposure = theme.exposure;
    this.floor.material.color.set(theme.floor);
    this.grid.paint(theme.grid);
    this.sky.color.set(theme.sky_light);
    this.sky.groundColor.set(theme.ground_light);
    this.sky.intensity = (this.quality.is_fine ? 1 : MORE_SKY) * theme.ambient;
    this.sun.intensity = theme.sun;
    this.box_lines.color.set(theme.box);
  }

  private resize(): void {
    if (this.renderer.xr.isPresenting) return;
    const { clientWidth: width, clientHeight: height } = this.parent;
    this.renderer.setPixelRatio(this.quality.pixel_ratio(devicePixelRatio));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / Math.max(1, height);
    this.on_resize();
    this.sun.castShadow = this.contact.is_shown = this.quality.has_shadows;
  }
}

function wished_quality(): Wish {
  const wish = page_options().get("quality");
  return wish === "best" || wish === "fast" ? wish : null;
}
