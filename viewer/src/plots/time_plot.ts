// A plot over time with uPlot: lines, dotted limits, a legend with values.

import uPlot from "uplot";

import { make, write } from "../page";
import {
  type Card,
  type Plot,
  type PlotInput,
  type TimeRange,
  PLOT_FONT,
  css_color,
  make_card,
  series_color,
} from "./plot";
import { thinned_rows } from "./bins";
import { type TimeSpec, index_at } from "./specs";

const AXIS_WIDTH = 46; // px
const AXIS_HEIGHT = 24; // px
const MOST_POINTS = 1200; // per line

export class TimePlot implements Plot {
  readonly card: HTMLElement;
  private readonly parts: Card;
  private readonly chart: uPlot;
  private readonly values: HTMLElement[] = [];

  constructor(
    private readonly spec: TimeSpec,
    on_zoom: (range: TimeRange) => void,
  ) {
    this.parts = make_card(spec.id, `${spec.title} (${spec.unit})`, () => this.chart.ctx.canvas);
    this.card = this.parts.card;
    this.chart = new uPlot(
      this.options(on_zoom),
      [[], ...spec.series.map(() => [])],
      this.parts.body,
    );
    for (const [i, { label }] of spec.series.entries()) this.add_legend(i, label);
  }

  draw({ history, range }: PlotInput): void {
    this.resize();
    const times = history.column("time_s");
    const first = Math.max(0, index_at(times, range.from) - 1);
    const end = Math.min(times.length, index_at(times, range.to) + 1);
    const rows = thinned_rows(first, end, history.first_row, MOST_POINTS);
    const pick = (column: Float64Array, scale: number): number[] =>
      rows.map((row) => column[row]! * scale);
    const lines = this.spec.series.map(({ column, scale }) => pick(history.column(column), scale));
    this.chart.setData([pick(times, 1), ...lines], false);
    this.chart.setScale("x", { min: range.from, max: range.to });
    this.show_values(lines);
  }

  resize(): void {
    const { clientWidth: width, clientHeight: height } = this.parts.body;
    const is_other = width !== this.chart.width || height !== this.chart.height;
    if (is_other && width > 0 && height > 0) this.chart.setSize({ width, height });
  }

  dispose(): void {
    this.chart.destroy();
  }

  private options(on_zoom: (range: TimeRange) => void): uPlot.Options {
    const axis = (): Partial<uPlot.Axis> => ({
      stroke: css_color("--quiet"),
      font: PLOT_FONT,
      grid: { stroke: css_color("--edge"), width: 1 },
      ticks: { show: false },
    });
    return {
      width: 320,
      height: 160,
      legend: { show: false },
      padding: [6, 16, 0, 0],
      cursor: {
        drag: { x: true, y: false, setScale: false },
        sync: { key: "time" },
        points: { show: false },
      },
      scales: { x: { time: false }, y: { range: (_, low, high) => this.span(low, high) } },
      axes: [
        { ...axis(), size: AXIS_HEIGHT, values: (_, ticks) => ticks.map((t) => `${t} s`) },
        { ...axis(), size: AXIS_WIDTH },
      ],
      series: [
        {},
        ...this.spec.series.map(({ label, is_main }, i) => ({
          label,
          stroke: series_color(i),
          width: is_main ? 2 : 1.25,
          points: { show: false },
        })),
      ],
      hooks: {
        drawAxes: [(chart) => this.draw_limits(chart)],
        setSelect: [
          (chart) => {
            if (chart.select.width < 4) return;
            const from = chart.posToVal(chart.select.left, "x");
            const to = chart.posToVal(chart.select.left + chart.select.width, "x");
            chart.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
            on_zoom({ from, to });
          },
        ],
      },
    };
  }

  // At least the plot's smallest range, with a margin.
  private span(low: number | null, high: number | null): uPlot.Range.MinMax {
    const [from, to] = [low ?? 0, high ?? 0];
    const missing = Math.max(0, this.spec.smallest_span - (to - from));
    const air = 0.06 * Math.max(to - from, this.spec.smallest_span);
    return [from - 0.5 * missing - air, to + 0.5 * missing + air];
  }

  private draw_limits(chart: uPlot): void {
    const { left, top, width, height } = chart.bbox;
    const { ctx } = chart;
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, top, width, height);
    ctx.clip();
    ctx.setLineDash([2 * devicePixelRatio, 4 * devicePixelRatio]);
    ctx.lineWidth = devicePixelRatio;
    for (const { series, value } of this.spec.limits) {
      if (!chart.series[series + 1]!.show) continue;
      const y = Math.round(chart.valToPos(value, "y", true));
      ctx.strokeStyle = series_color(series);
      ctx.beginPath();
      ctx.moveTo(left, y);
      ctx.lineTo(left + width, y);
      ctx.stroke();
    }
    ctx.restore();
  }

  private add_legend(index: number, label: string): void {
    const value = make("output");
    const swatch = make("i");
    swatch.style.background = series_color(index);
    const item = make("button", "", swatch, label, value);
    item.type = "button";
    item.title = "Show or hide this line";
    item.setAttribute("aria-pressed", "true");
    item.addEventListener("click", () => {
      const is_shown = !this.chart.series[index + 1]!.show;
      this.chart.setSeries(index + 1, { show: is_shown });
      item.setAttribute("aria-pressed", String(is_shown));
    });
    this.values.push(value);
    this.parts.legend.append(item);
  }

  // Under the cursor, else the newest.
  private show_values(lines: number[][]): void {
    const index = this.chart.cursor.idx ?? null;
    for (const [i, output] of this.values.entries()) {
      const value = index === null ? lines[i]!.at(-1) : lines[i]![index];
      write(output, value === undefined || !Number.isFinite(value) ? "" : short(value));
    }
  }
}

function short(value: number): string {
  const size = Math.abs(value);
  const text = value.toFixed(size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2);
  return text === "-0.00" ? "0.00" : text;
}
