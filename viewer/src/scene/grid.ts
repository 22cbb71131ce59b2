// The floor's lines: every half metre, stronger every second metre, thin at any distance, fading
// out far away.

import { Color, Mesh, PlaneGeometry, ShaderMaterial } from "three";

const SIZE = 26; // m

const VERTEX = `
varying vec2 at;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  at = world.xy;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

const FRAGMENT = `
varying vec2 at;
uniform vec3 color;
uniform float strength;
float line(float spacing, float width) {
  vec2 here = at / spacing;
  vec2 away = abs(fract(here - 0.5) - 0.5) / max(fwidth(here), vec2(1e-6));
  return 1.0 - min(min(away.x, away.y) / width, 1.0);
}
void main() {
  float fade = 1.0 - smoothstep(3.0, 12.0, length(at));
  float shown = max(0.4 * line(0.5, 1.0), 0.8 * line(2.0, 1.0)) * fade * strength;
  if (shown < 0.01) discard;
  gl_FragColor = vec4(color, shown);
}`;

export class Grid {
  readonly mesh: Mesh<PlaneGeometry, ShaderMaterial>;

  constructor() {
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { color: { value: new Color() }, strength: { value: 0.6 } },
      transparent: true,
      depthWrite: false,
    });
    this.mesh = new Mesh(new PlaneGeometry(SIZE, SIZE), material);
  }

  paint(color: number): void {
    (this.mesh.material.uniforms.color!.value as Color).set(color).convertLinearToSRGB();
  }
}
