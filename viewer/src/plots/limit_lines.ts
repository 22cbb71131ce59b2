// When which limit acts: one row for each that did during the shown time.

import { limit_column } from "../data/history";
import { ACTIVE_COLOR, NEAR_COLOR, TARGET_COLOR } from "../theme";
import { type Span, spans_of } from "./bins";
import { type Plot, type PlotInput, Surface, css_color, hex_color, make_card } from "./plot";
import { index_at } from "./specs";

const ROW = 18; // px
const NAMES = 84; // px
const BOTTOM = 22; // px

const COLORS: Record<number, string> = {
  [-1]: hex_color(TARGET_COLOR),
  1: hex_color(NEAR_COLOR),
  2: hex_color(ACTIVE_COLOR),
};

export class LimitLines implements Plot {
  readonly card: HTMLElement;
  private readonly surface: Surface;

  constructor() {
    const { card, body, legend } = make_card(
      "limits",
      "Limits that act",
      () => this.surface.canvas,
    );
    this.card = card;
    this.surface = new Surface(body);
    for (const [state, word] of [
      [-1, "lower"],
      [1, "upper"],
      [2, "violated"],
    ] as const) {
      const swatch = document.createElement("i");
      swatch.style.background = COLORS[state]!;
      const item = document.createElement("span");
      item.append(swatch, word);
      legend.append(item);
    }
  }

  draw({ scene, history, range }: PlotInput): void {
    const times = history.column("time_s");
    const [from, to] = [index_at(times, range.from), index_at(times, range.to)];
    const part = times.subarray(from, to);
    const rows = scene.limits
      .map((limit) => {
        const states = history.column(limit_column(limit)).subarray(from, to);
        return { name: limit.name, spans: spans_of(part, states) };
      })
      .filter(({ spans }) => spans.length > 0);
    const context = this.surface.begin();
    if (rows.length === 0) this.say_none(context);
    const at = (time: number): number =>
      NAMES + ((time - range.from) / (range.to - range.from)) * (this.surface.width - NAMES - 8);
    this.draw_axis(context, range.from, range.to, at);
    const most = Math.max(1, Math.floor((this.surface.height - BOTTOM) / ROW));
    for (const [i, { name, spans }] of rows.slice(0, most).entries()) {
      this.draw_row(context, i, name, spans, at);
    }
    if (rows.length > most) {
      context.fillStyle = css_color("--quiet");
      context.fillText(`${rows.length - most} more`, 4, this.surface.height - 8);
    }
  }

  resize(): void {
    this.surface.resize();
  }

  dispose(): void {}

  private say_none(context: CanvasRenderingContext2D): void {
    context.fillStyle = css_color("--quiet");
    context.textAlign = "center";
    const { width, height } = this.surface;
    context.fillText("none during this time", 0.5 * width, 0.5 * (height - BOTTOM));
  }

  private draw_axis(
    context: CanvasRenderingContext2D,
    from: number,
    to: number,
    at: (time: number) => number,
  ): void {
    const step = [0.5, 1, 2, 5, 10, 20, 60].find((s) => (to - from) / s <= 6) ?? 60;
    context.textAlign = "center";
    for (let time = Math.ceil(from / step) * step; time <= to; time += step) {
      context.fillStyle = css_color("--edge");
      context.fillRect(Math.round(at(time)), 0, 1, this.surface.height - BOTTOM);
      context.fillStyle = css_color("--quiet");
      context.fillText(`${Number(time.toFixed(1))} s`, at(time), this.surface.height - 8);
    }
  }

  private draw_row(
    context: CanvasRenderingContext2D,
    row: number,
    name: string,
    spans: Span[],
    at: (time: number) => number,
  ): void {
    const y = row * ROW;
    context.textAlign = "right";
    context.fillStyle = css_color("--ink");
    context.fillText(name, NAMES - 8, y + 0.5 * ROW + 4, NAMES - 12);
    for (const { from, to, state } of spans) {
      context.fillStyle = COLORS[state] ?? COLORS[2]!;
      context.fillRect(at(from), y + 3, Math.max(2, at(to) - at(from)), ROW - 6);
    }
  }
}
