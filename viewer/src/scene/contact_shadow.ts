// Soft shadows where things stand on the floor: what is just above it, seen from below and blurred.
// One pass of the shapes and two over a small picture.

import {
  DoubleSide,
  Group,
  type IUniform,
  Mesh,
  MeshBasicMaterial,
  MeshDepthMaterial,
  type Object3D,
  OrthographicCamera,
  PlaneGeometry,
  type Scene,
  ShaderMaterial,
  UniformsUtils,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { HorizontalBlurShader } from "three/examples/jsm/shaders/HorizontalBlurShader.js";
import { VerticalBlurShader } from "three/examples/jsm/shaders/VerticalBlurShader.js";

const LAYER = 1; // of what casts it
const PIXELS = 512;
const SIZE = 7; // m, of the floor that has them
const HEIGHT = 0.45; // m above the floor: what is higher casts none
const ABOVE = 0.003; // m above the floor
const DARKNESS = 1.4;
const OPACITY = 0.42;
const BLUR = 2.2; // pixels

export class ContactShadow {
  readonly group = new Group(); // at the floor
  private readonly plane: Mesh<PlaneGeometry, MeshBasicMaterial>;
  private readonly camera = new OrthographicCamera(-SIZE / 2, SIZE / 2, SIZE / 2, -SIZE / 2, 0, HEIGHT);
  private readonly depths = new MeshDepthMaterial();
  private readonly first = new WebGLRenderTarget(PIXELS, PIXELS);
  private readonly second = new WebGLRenderTarget(PIXELS, PIXELS);
  private readonly wide = blur(HorizontalBlurShader, "h");
  private readonly high = blur(VerticalBlurShader, "v");
  private readonly screen = new Mesh(new PlaneGeometry(SIZE, SIZE));

  constructor() {
    const material = new MeshBasicMaterial({
      map: this.first.texture,
      transparent: true,
      opacity: OPACITY,
      depthWrite: false,
      toneMapped: false,
      side: DoubleSide, // the picture from below is mirrored
    });
    this.plane = new Mesh(new PlaneGeometry(SIZE, SIZE).scale(1, -1, 1), material);
    this.plane.position.z = ABOVE;
    this.plane.renderOrder = -1; // under whatever is see-through
    this.camera.rotation.x = Math.PI; // looks up
    this.camera.layers.set(LAYER);
    this.screen.position.z = HEIGHT / 2;
    this.screen.layers.set(LAYER);
    this.screen.visible = false;
    this.group.add(this.plane, this.camera, this.screen);
    this.depths.depthTest = this.depths.depthWrite = false;
    this.depths.onBeforeCompile = (shader) => {
      shader.fragmentShader = shader.fragmentShader.replace(
        "gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );",
        `gl_FragColor = vec4( vec3( 0.0 ), ${DARKNESS.toFixed(2)} * ( 1.0 - fragCoordZ ) );`,
      );
    };
  }

  // All shapes under `root` that cast shadows cast these, too.
  add(root: Object3D): void {
    root.traverse((part) => part.castShadow && part.layers.enable(LAYER));
  }

  set is_shown(is_shown: boolean) {
    this.plane.visible = is_shown;
  }

  update(renderer: WebGLRenderer, scene: Scene): void {
    if (!this.plane.visible) return;
    const { background, fog } = scene;
    scene.background = scene.fog = null;
    scene.overrideMaterial = this.depths;
    renderer.shadowMap.autoUpdate = false;
    this.draw(renderer, scene, this.first);
    scene.overrideMaterial = null;
    this.screen.visible = true;
    this.blur(renderer, this.wide, this.first, this.second);
    this.blur(renderer, this.high, this.second, this.first);
    this.screen.visible = false;
    renderer.setRenderTarget(null);
    renderer.shadowMap.autoUpdate = true;
    Object.assign(scene, { background, fog });
  }

  private blur(
    renderer: WebGLRenderer,
    material: ShaderMaterial,
    from: WebGLRenderTarget,
    to: WebGLRenderTarget,
  ): void {
    (material.uniforms.tDiffuse as IUniform).value = from.texture;
    this.screen.material = material;
    this.draw(renderer, this.screen, to);
  }

  private draw(renderer: WebGLRenderer, what: Object3D, to: WebGLRenderTarget): void {
    renderer.setRenderTarget(to);
    renderer.clear();
    renderer.render(what, this.camera);
  }
}

interface Shader {
  uniforms: Record<string, IUniform>;
  vertexShader: string;
  fragmentShader: string;
}

function blur({ uniforms, ...programs }: Shader, step: string): ShaderMaterial {
  const own = UniformsUtils.clone(uniforms) as Record<string, IUniform>;
  own[step]!.value = BLUR / PIXELS;
  return new ShaderMaterial({ ...programs, uniforms: own, depthTest: false, side: DoubleSide });
}
