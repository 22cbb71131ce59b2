// How long cycles take: how often each time has come, with median, 99 % and longest.

import { write } from "../page";
import { bins_of, quantile } from "./bins";
import { type Plot, type PlotInput, Surface, css_color, make_card, series_color } from "./plot";
import { index_at } from "./specs";

const BINS = 48;
const [LEFT, BOTTOM, TOP] = [8, 22, 6]; // px

export class Histogram implements Plot {
  readonly card: HTMLElement;
  private readonly surface: Surface;
  private readonly legend: HTMLElement;

  constructor() {
    const { card, body, legend } = make_card(
      "cycle-time",
      "Cycle time (\u00b5s)",
      () => this.surface.canvas,
    );
    this.card = card;
    this.legend = legend;
    this.surface = new Surface(body);
  }

  draw({ history, range, scene }: PlotInput): void {
    const times = history.column("time_s");
    const [from, to] = [index_at(times, range.from), index_at(times, range.to)];
    const all = history.column("cycle_time_us").subarray(from, to).filter(Number.isFinite);
    const longest = history.column("cycle_time_max_us").subarray(from, to).filter(Number.isFinite);
    const context = this.surface.begin();
    if (all.length === 0) return;
    const top = Math.max(...longest, ...all);
    const end = Math.max(2 * quantile(all, 0.99), 1);
    const budget = 1e6 / scene.rate_hz;
    write(
      this.legend,
      `median ${quantile(all, 0.5).toFixed(0)}, 99 % ${quantile(all, 0.99).toFixed(0)}, ` +
        `longest ${top.toFixed(0)} of ${budget.toFixed(0)}`,
    );
    this.draw_bars(context, bins_of(all, BINS, end), end);
  }

  resize(): void {
    this.surface.resize();
  }

  dispose(): void {}

  private draw_bars(context: CanvasRenderingContext2D, counts: number[], end: number): void {
    const { width, height } = this.surface;
    const most = Math.max(...counts, 1);
    const [plot_width, plot_height] = [width - 2 * LEFT, height - BOTTOM - TOP];
    const step = plot_width / counts.length;
    context.fillStyle = series_color(0);
    for (const [i, count] of counts.entries()) {
      const tall = (count / most) * plot_height;
      context.fillRect(LEFT + i * step, TOP + plot_height - tall, Math.max(1, step - 1.5), tall);
    }
    context.fillStyle = css_color("--quiet");
    context.textAlign = "center";
    for (const share of [0.25, 0.5, 0.75]) {
      context.fillText((share * end).toFixed(0), LEFT + share * plot_width, height - 8);
    }
    context.fillRect(LEFT, TOP + plot_height, plot_width, 1);
  }
}
