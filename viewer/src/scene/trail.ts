// The way that a point has gone during the last seconds, fading out.

import { BufferAttribute, BufferGeometry, Color, Line, ShaderMaterial } from "three";

import type { Vec3 } from "../messages";

const LENGTH = 600; // points
const SMALLEST_STEP = 0.004; // m
const JUMP = 0.5; // m; a step that long is a new start

const VERTEX = `
attribute float age;
varying float shown;
void main() {
  shown = 1.0 - age;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;
const FRAGMENT = `
varying float shown;
uniform vec3 color;
void main() { gl_FragColor = vec4(color, 0.85 * shown); }`;

export class Trail {
  readonly line: Line<BufferGeometry, ShaderMaterial>;
  private readonly points: Vec3[] = [];
  private readonly positions = new BufferAttribute(new Float32Array(3 * LENGTH), 3);
  private readonly ages = new BufferAttribute(new Float32Array(LENGTH), 1);

  constructor(color: number) {
    const shape = new BufferGeometry();
    shape.setAttribute("position", this.positions);
    shape.setAttribute("age", this.ages);
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { color: { value: new Color(color).convertLinearToSRGB() } },
      transparent: true,
      depthWrite: false,
    });
    this.line = new Line(shape, material);
    this.line.frustumCulled = false;
  }

  clear(): void {
    this.points.length = 0;
    this.line.geometry.setDrawRange(0, 0);
  }

  add(point: Vec3): void {
    const last = this.points.at(-1);
    const step = last ? Math.hypot(...point.map((x, i) => x - last[i]!)) : Infinity;
    if (step < SMALLEST_STEP) return;
    if (last && step > JUMP) this.points.length = 0;
    this.points.push(point);
    if (this.points.length > LENGTH) this.points.shift();
    const count = this.points.length;
    for (const [i, p] of this.points.entries()) {
      this.positions.setXYZ(i, ...p);
      this.ages.setX(i, 1 - (i + 1) / count);
    }
    this.positions.needsUpdate = this.ages.needsUpdate = true;
    this.line.geometry.setDrawRange(0, count);
  }
}
