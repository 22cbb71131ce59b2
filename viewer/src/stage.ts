// The empty stage: camera, light, floor, box of the handle, and drawing at the screen's pace.

import {
  Box3,
  Box3Helper,
  CircleGeometry,
  Color,
  DirectionalLight,
  Fog,
  GridHelper,
  HemisphereLight,
  LineBasicMaterial,
  Mesh,
  MeshStandardMaterial,
  NeutralToneMapping,
  PCFShadowMap,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import type { SceneBox, Vec3 } from "./messages";
import { Quality } from "./quality";
import { current_theme, on_theme_change } from "./theme";

const NARROW_PX = 760; // as in style.css
const EYE_ABOVE = 1.25; // m, above what is looked at

// Pixels that the panel takes away at the right or, on a narrow screen, at the bottom.
function hidden_by_panel(width: number, height: number): { x: number; y: number } {
  return width > NARROW_PX ? { x: 288, y: 0 } : { x: 0, y: 0.45 * height };
}

export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(38, 1, 0.05, 60);
  readonly canvas: HTMLCanvasElement;
  readonly controls: OrbitControls;
  private readonly renderer: WebGLRenderer;
  private readonly sun = new DirectionalLight();
  private readonly sky = new HemisphereLight();
  private readonly floor = new Mesh(
    new CircleGeometry(30, 64),
    new MeshStandardMaterial({ roughness: 1 }),
  );
  private readonly box_lines = new LineBasicMaterial({ transparent: true, opacity: 0.5 });
  private readonly quality = new Quality();
  private grid = new GridHelper();
  private floor_z_m = 0;

  constructor(private readonly parent: HTMLElement) {
    this.renderer = new WebGLRenderer({ antialias: true, powerPreference: "high-performance" });
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.canvas = this.renderer.domElement;
    parent.append(this.canvas);

    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.maxPolarAngle = 0.53 * Math.PI; // not from below the floor
    this.controls.minDistance = 0.6;
    this.controls.maxDistance = 14;

    this.floor.receiveShadow = true;
    this.add_sun();
    this.scene.add(this.sky, this.floor);
    this.paint();
    on_theme_change(() => this.paint());
    new ResizeObserver(() => this.resize()).observe(parent);
    this.resize();
  }

  // Draws before every repaint of the screen, after `prepare`.
  run(prepare: () => void): void {
    const draw = (now_ms: number): void => {
      if (this.quality.observe(now_ms)) this.resize();
      prepare();
      this.controls.update();
      this.renderer.render(this.scene, this.camera);
      requestAnimationFrame(draw);
    };
    requestAnimationFrame(draw);
  }

  // Looks into the cell through its open side, beside a corner, like a tall person.
  frame(box: SceneBox, floor_z_m: number): void {
    this.floor_z_m = floor_z_m;
    this.paint();
    const low = new Vector3(...box.min_m);
    const high = new Vector3(...box.max_m);
    const lines = new Box3Helper(new Box3(low, high));
    lines.material = this.box_lines;
    this.scene.add(lines);

    const size = new Vector3().subVectors(high, low);
    const center = new Vector3().addVectors(low, high).multiplyScalar(0.5);
    const away = Math.max(2, 0.7 * size.y);
    this.controls.target.copy(center);
    this.camera.position.set(center.x + 0.36 * size.x, low.y - away, center.z + EYE_ABOVE);
    this.controls.update();
  }

  // Turns the camera half way to what matters at first.
  look_at(p_B: Vec3): void {
    this.controls.target.lerp(new Vector3(...p_B), 0.5);
  }

  on_screen(p_B: Vec3): { x: number; y: number } {
    const seen = new Vector3(...p_B).project(this.camera);
    const area = this.canvas.getBoundingClientRect();
    return {
      x: area.left + 0.5 * (1 + seen.x) * area.width,
      y: area.top + 0.5 * (1 - seen.y) * area.height,
    };
  }

  private add_sun(): void {
    this.sun.position.set(1.8, -2.6, 7);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.radius = 6;
    this.sun.shadow.intensity = 0.45;
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.02;
    const view = this.sun.shadow.camera;
    Object.assign(view, { left: -4.5, right: 4.5, top: 4.5, bottom: -4.5, near: 1, far: 14 });
    this.scene.add(this.sun);
  }

  private paint(): void {
    const theme = current_theme();
    this.scene.background = new Color(theme.background);
    this.scene.fog = new Fog(theme.background, 9, 22);
    this.floor.material.color.set(theme.floor);
    this.sky.color.set(theme.sky_light);
    this.sky.groundColor.set(theme.ground_light);
    this.sky.intensity = theme.ambient;
    this.sun.intensity = theme.sun;
    this.box_lines.color.set(theme.box);

    this.scene.remove(this.grid);
    this.grid.dispose();
    this.grid = new GridHelper(40, 80, theme.grid_strong, theme.grid);
    this.grid.rotation.x = Math.PI / 2;
    this.floor.position.z = this.floor_z_m;
    this.grid.position.z = this.floor_z_m + 0.002;
    this.scene.add(this.grid);
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.parent;
    this.renderer.setPixelRatio(this.quality.pixel_ratio(devicePixelRatio));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / Math.max(1, height);
    this.camera.fov = width > NARROW_PX ? 38 : 58;
    const hidden = hidden_by_panel(width, height);
    this.camera.setViewOffset(width, height, 0.5 * hidden.x, 0.5 * hidden.y, width, height);
    this.sun.castShadow = this.quality.has_shadows;
  }
}
