// Places on the floor that the handle is to be brought to: a disc with its number and an arrow that
// the hand axis is to point along. The next one is bright, those that were reached have a tick. Below
// the handle the same arrow shows where it is and points.

import {
  CanvasTexture,
  CircleGeometry,
  Group,
  Mesh,
  MeshBasicMaterial,
  type Quaternion,
  Shape,
  ShapeGeometry,
  Vector3,
} from "three";

import type { SceneCheckpoint } from "../messages";
import { FORCE_COLOR, GOOD_COLOR, TARGET_COLOR } from "../theme";

const RADIUS = 0.1; // m: nearer than this it is reached (hg/signals/event_rule.h)
const ARROW = 0.42; // m, from the middle
const ABOVE = 0.006; // m above the floor
const FAINT = 0.45;
const TEXTURE = 128; // pixels

interface Mark {
  paints: MeshBasicMaterial[];
  label: MeshBasicMaterial;
}

export class Checkpoints {
  readonly group = new Group();
  private readonly marks: Mark[] = [];
  private readonly pointer = new Group();
  private reached = 0; // in their order

  constructor(places: SceneCheckpoint[], floor_z_m: number) {
    this.group.position.z = floor_z_m + ABOVE;
    if (places.length === 0) return;
    for (const place of places) this.add(place);
    this.pointer.add(new Mesh(arrow_shape(0, ARROW), paint(FORCE_COLOR, 0.9)));
    this.pointer.position.z = ABOVE;
    this.group.add(this.pointer);
    this.color();
  }

  show(p_B_H: Vector3, attitude: Quaternion, reached: number): void {
    if (reached !== this.reached) {
      this.reached = reached;
      this.color();
    }
    const axis = new Vector3(0, 0, 1).applyQuaternion(attitude);
    this.pointer.position.setX(p_B_H.x).setY(p_B_H.y);
    this.pointer.rotation.z = Math.atan2(axis.y, axis.x);
  }

  private add({ x_m, y_m, azimuth_rad }: SceneCheckpoint): void {
    const group = new Group();
    const disc = paint(TARGET_COLOR, 1);
    const arrow = paint(TARGET_COLOR, 1);
    const label = new MeshBasicMaterial({ transparent: true, depthWrite: false });
    const pointer = new Mesh(arrow_shape(RADIUS, ARROW), arrow);
    pointer.rotation.z = azimuth_rad;
    const words = new Mesh(new CircleGeometry(0.8 * RADIUS, 32), label);
    words.position.z = ABOVE;
    group.add(new Mesh(new CircleGeometry(RADIUS, 48), disc), pointer, words);
    group.position.set(x_m, y_m, 0);
    this.marks.push({ paints: [disc, arrow], label });
    this.group.add(group);
  }

  private color(): void {
    for (const [index, { paints, label }] of this.marks.entries()) {
      label.map?.dispose();
      label.map = text_texture(index < this.reached ? "\u2713" : String(index + 1));
      const is_next = index === this.reached;
      for (const each of [...paints, label]) each.opacity = is_next ? 1 : FAINT;
      for (const each of paints) each.color.set(index < this.reached ? GOOD_COLOR : TARGET_COLOR);
    }
  }
}

function paint(color: number, opacity: number): MeshBasicMaterial {
  return new MeshBasicMaterial({ color, opacity, transparent: true, depthWrite: false });
}

// Along x, from `begin` to `end`, m.
function arrow_shape(begin: number, end: number): ShapeGeometry {
  const shape = new Shape();
  const neck = end - 0.14;
  shape.moveTo(begin, -0.03);
  for (const [x, y] of [
    [neck, -0.03],
    [neck, -0.09],
    [end, 0],
    [neck, 0.09],
    [neck, 0.03],
    [begin, 0.03],
  ] as const) {
    shape.lineTo(x, y);
  }
  return new ShapeGeometry(shape);
}

function text_texture(text: string): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = TEXTURE;
  const pen = canvas.getContext("2d")!;
  pen.fillStyle = "#ffffff";
  pen.font = `600 ${0.8 * TEXTURE}px sans-serif`;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.fillText(text, TEXTURE / 2, 0.54 * TEXTURE);
  return new CanvasTexture(canvas);
}
