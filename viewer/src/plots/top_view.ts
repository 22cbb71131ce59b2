// Handle, elbow and gantry from above, with the box that limits handle and elbow, as Fig. 6(d) of
// the paper: x to the right, y up.

import type { Scene } from "../messages";
import { make } from "../page";
import { ELBOW_COLOR, FORCE_COLOR } from "../theme";
import {
  type Plot,
  type PlotInput,
  Surface,
  css_color,
  hex_color,
  make_card,
} from "./plot";
import { index_at } from "./specs";

const AIR = 0.35; // m around the box
const TICKS = [-2, -1, 0, 1, 2]; // m

interface Track {
  label: string;
  color: string;
  columns: [string, string];
}

export class TopView implements Plot {
  readonly card: HTMLElement;
  private readonly surface: Surface;
  private readonly tracks: Track[];

  constructor(scene: Scene) {
    const { card, body, legend } = make_card(
      "top-view",
      "From above (m)",
      () => this.surface.canvas,
    );
    this.card = card;
    this.surface = new Surface(body);
    this.tracks = [
      { label: "elbow", color: hex_color(ELBOW_COLOR), columns: ["elbow_x_m", "elbow_y_m"] },
      { label: "handle", color: hex_color(FORCE_COLOR), columns: ["handle_x_m", "handle_y_m"] },
    ];
    const gantry = scene.device.joints.slice(0, scene.gantry_joints);
    if (gantry.length === 2 && gantry.every(({ type }) => type === "prismatic")) {
      const columns: [string, string] = [`device.${gantry[0]!.name}`, `device.${gantry[1]!.name}`];
      this.tracks.unshift({ label: "gantry", color: css_color("--device"), columns });
    }
    for (const { label, color } of this.tracks) {
      const swatch = make("i");
      swatch.style.background = color;
      legend.append(make("span", "", swatch, label));
    }
  }

  draw({ scene, history, range }: PlotInput): void {
    const context = this.surface.begin();
    const { width, height } = this.surface;
    const [low, high] = [scene.box.min_m, scene.box.max_m];
    const size = [high[0] - low[0] + 2 * AIR, high[1] - low[1] + 2 * AIR] as const;
    const scale = Math.min(width / size[0], height / size[1]);
    const middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])] as const;
    const x_at = (x: number): number => 0.5 * width + (x - middle[0]) * scale;
    const y_at = (y: number): number => 0.5 * height - (y - middle[1]) * scale;

    context.fillStyle = css_color("--quiet");
    context.strokeStyle = css_color("--edge");
    context.lineWidth = 1;
    for (const tick of TICKS) {
      context.strokeRect(x_at(tick), 0, 0, height);
      context.strokeRect(x_at(low[0] - AIR), y_at(tick), size[0] * scale, 0);
      context.textAlign = "left";
      context.fillText(String(tick), x_at(low[0] - AIR) + 2, y_at(tick) - 2);
      context.fillText(String(tick), x_at(tick) + 2, height - 2);
    }
    context.strokeStyle = css_color("--quiet");
    context.setLineDash([2, 4]);
    context.strokeRect(
      x_at(low[0]),
      y_at(high[1]),
      (high[0] - low[0]) * scale,
      (high[1] - low[1]) * scale,
    );
    context.setLineDash([]);

    const times = history.column("time_s");
    const [from, to] = [index_at(times, range.from), index_at(times, range.to)];
    for (const { color, columns } of this.tracks) {
      const xs = history.column(columns[0]).subarray(from, to);
      const ys = history.column(columns[1]).subarray(from, to);
      context.strokeStyle = context.fillStyle = color;
      context.lineWidth = 1.5;
      context.beginPath();
      for (let i = 0; i < xs.length; i++) context.lineTo(x_at(xs[i]!), y_at(ys[i]!));
      context.stroke();
      const last = xs.length - 1;
      if (last < 0) continue;
      context.beginPath();
      context.arc(x_at(xs[last]!), y_at(ys[last]!), 4, 0, 2 * Math.PI);
      context.fill();
    }
  }

  resize(): void {
    this.surface.resize();
  }

  dispose(): void {}
}
