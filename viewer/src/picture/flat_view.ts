// One flat view on a canvas: bodies, handle, force, target, places to go to.

import { type Pixel, is_within_grab } from "../hand/hand_view";
import type { Frame, Scene, Vec3 } from "../messages";
import { make } from "../page";
import { Surface, css_color, hex_color } from "../plots/plot";
import { CONTACT_COLOR, FORCE_COLOR, GOOD_COLOR, TARGET_COLOR } from "../theme";
import type { Body, Kind } from "./bodies";
import { type Point, hull_of } from "./outline";
import { type Area, type Facing, type Projection, dot, fitted, projected, unprojected } from "./projection";

const RING_PX = 14;
const FORCE_M_PER_N = 0.01;
const REACHED_M = 0.1; // radius of a place (hg/signals/event_rule.h)

const FILL: Record<Kind, string> = { device: "--device", twin: "--twin", remote: "--remote", target: "--remote", base: "--base", surface: "--series-2", wall: "--quiet" };
const OPACITY: Record<Kind, number> = { device: 0.55, twin: 0.5, remote: 0.6, target: 0.18, base: 0.45, surface: 0.3, wall: 0.1 };

export interface FlatContent {
  scene: Scene;
  frame: Frame;
  bodies: Body[];
  target: Vec3 | null;
  reached: number; // places that have been reached
}

export class FlatView {
  readonly part: HTMLElement;
  private readonly surface: Surface;
  private projection: Projection;
  private colors = new Map<string, string>();

  constructor(
    private readonly facing: Facing,
    private area: Area,
  ) {
    const body = make("div", "flat-body");
    this.surface = new Surface(body);
    this.surface.canvas.setAttribute("role", "img");
    this.surface.canvas.setAttribute("aria-label", `${facing.name}: device, twin, handle and force`);
    this.part = make("figure", "flat", make("figcaption", "", facing.name), body);
    this.projection = fitted(facing, area, 1, 1);
  }

  get canvas(): HTMLCanvasElement {
    return this.surface.canvas;
  }

  look_at(area: Area): void {
    this.area = area;
  }

  repaint(): void {
    this.colors.clear();
  }

  into(): Vec3 {
    return this.facing.into;
  }

  // In the window.
  on_screen(p_B: Vec3): Pixel {
    const { left, top } = this.canvas.getBoundingClientRect();
    const [x, y] = projected(this.projection, p_B);
    return { x: left + x, y: top + y };
  }

  is_near(pixel: Pixel, p_B: Vec3): boolean {
    const { left, top, right, bottom } = this.canvas.getBoundingClientRect();
    const is_inside = pixel.x >= left && pixel.x <= right && pixel.y >= top && pixel.y <= bottom;
    return is_inside && is_within_grab(pixel, this.on_screen(p_B));
  }

  origin_of(pixel: Pixel): Vec3 {
    const { left, top } = this.canvas.getBoundingClientRect();
    return unprojected(this.projection, [pixel.x - left, pixel.y - top]);
  }

  draw(content: FlatContent): void {
    const pen = this.surface.begin();
    this.projection = fitted(this.facing, this.area, this.surface.width, this.surface.height);
    this.draw_ground(pen, content.scene);
    for (const body of content.bodies) this.draw_body(pen, body);
    this.draw_box(pen, content.scene);
    if (this.facing.into[2] !== 0) this.draw_places(pen, content);
    this.draw_hand(pen, content);
  }

  private color(name: string): string {
    const known = this.colors.get(name);
    if (known) return known;
    const color = css_color(name);
    this.colors.set(name, color);
    return color;
  }

  // A grid of 1 m, and the floor as a line where it is seen from the side.
  private draw_ground(pen: CanvasRenderingContext2D, { floor_z_m }: Scene): void {
    const { width, height } = this.surface;
    const { origin, scale } = this.projection;
    pen.strokeStyle = this.color("--edge");
    pen.lineWidth = 1;
    pen.beginPath();
    for (let x = origin[0] % scale; x < width; x += scale) {
      pen.moveTo(x, 0);
      pen.lineTo(x, height);
    }
    for (let y = origin[1] % scale; y < height; y += scale) {
      pen.moveTo(0, y);
      pen.lineTo(width, y);
    }
    pen.stroke();
    if (this.facing.up[2] === 0) return;
    const [, floor] = projected(this.projection, [0, 0, floor_z_m]);
    pen.fillStyle = this.color("--trough");
    pen.fillRect(0, floor, width, height - floor);
  }

  private draw_body(pen: CanvasRenderingContext2D, { kind, is_touched, points }: Body): void {
    const corners = hull_of(points.map((p) => projected(this.projection, p)));
    if (corners.length === 0) return;
    const color = is_touched ? hex_color(CONTACT_COLOR) : this.color(FILL[kind]);
    trace(pen, corners);
    pen.fillStyle = pen.strokeStyle = color;
    pen.globalAlpha = OPACITY[kind];
    pen.fill();
    pen.globalAlpha = Math.min(1, 1.8 * OPACITY[kind]);
    pen.lineWidth = 1.2;
    pen.stroke();
    pen.globalAlpha = 1;
  }

  private draw_box(pen: CanvasRenderingContext2D, { box }: Scene): void {
    const [a, b] = [projected(this.projection, box.min_m), projected(this.projection, box.max_m)];
    pen.strokeStyle = this.color("--quiet");
    pen.setLineDash([2, 4]);
    pen.strokeRect(Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.abs(b[0] - a[0]), Math.abs(b[1] - a[1]));
    pen.setLineDash([]);
  }

  // Numbered discs with the direction of the hand axis; the next one is bright.
  private draw_places(pen: CanvasRenderingContext2D, { scene, reached }: FlatContent): void {
    pen.textAlign = "center";
    for (const [i, { x_m, y_m, azimuth_rad }] of scene.checkpoints.entries()) {
      const [x, y] = projected(this.projection, [x_m, y_m, 0]);
      const radius = Math.max(7, REACHED_M * this.projection.scale);
      pen.globalAlpha = i === reached ? 1 : 0.45;
      pen.fillStyle = pen.strokeStyle = hex_color(i < reached ? GOOD_COLOR : TARGET_COLOR);
      pen.beginPath();
      pen.arc(x, y, radius, 0, 2 * Math.PI);
      pen.fill();
      arrow(pen, [x, y], [x + 4 * radius * Math.cos(azimuth_rad), y - 4 * radius * Math.sin(azimuth_rad)]);
      pen.fillStyle = "#ffffff";
      pen.fillText(i < reached ? "\u2713" : String(i + 1), x, y + 4);
      pen.globalAlpha = 1;
    }
  }

  private draw_hand(pen: CanvasRenderingContext2D, { frame, target }: FlatContent): void {
    const at = projected(this.projection, frame.p_B_H_m);
    if (target) {
      const goal = projected(this.projection, target);
      pen.strokeStyle = hex_color(TARGET_COLOR);
      pen.setLineDash([5, 4]);
      trace(pen, [at, goal]);
      pen.stroke();
      pen.setLineDash([]);
      ring(pen, goal, 5);
    }
    pen.strokeStyle = this.color("--hand");
    pen.lineWidth = 2.5;
    ring(pen, at, RING_PX);
    const { right, up } = this.facing;
    const length = FORCE_M_PER_N * this.projection.scale;
    const [x, y] = [dot(frame.force_N, right) * length, dot(frame.force_N, up) * length];
    pen.strokeStyle = pen.fillStyle = hex_color(FORCE_COLOR);
    pen.lineWidth = 3.5;
    if (Math.hypot(x, y) > 2) arrow(pen, at, [at[0] + x, at[1] - y]);
  }
}

function trace(pen: CanvasRenderingContext2D, points: readonly Point[]): void {
  pen.beginPath();
  for (const [x, y] of points) pen.lineTo(x, y);
  if (points.length > 2) pen.closePath();
}

function ring(pen: CanvasRenderingContext2D, [x, y]: Point, radius: number): void {
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  pen.stroke();
}

function arrow(pen: CanvasRenderingContext2D, from: Point, to: Point): void {
  const angle = Math.atan2(to[1] - from[1], to[0] - from[0]);
  const head = (side: number): Point => [
    to[0] - 9 * Math.cos(angle + side),
    to[1] - 9 * Math.sin(angle + side),
  ];
  trace(pen, [from, to]);
  pen.stroke();
  trace(pen, [to, head(0.5), head(-0.5)]);
  pen.fill();
}
