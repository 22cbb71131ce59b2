// What all plots have in common: a card with title, legend and a canvas.

import type { Table } from "../data/history";
import { icon } from "../icons";
import type { Scene } from "../messages";
import { download, make, make_button } from "../page";

export interface TimeRange {
  from: number; // s
  to: number;
}

export interface PlotInput {
  scene: Scene;
  history: Table;
  range: TimeRange;
}

export interface Plot {
  readonly card: HTMLElement;
  draw(input: PlotInput): void;
  resize(): void;
  dispose(): void;
}

export interface Card {
  card: HTMLElement;
  legend: HTMLElement;
  body: HTMLElement;
}

export function make_card(id: string, title: string, picture: () => HTMLCanvasElement): Card {
  const legend = make("div", "legend");
  const save = make_button("", "Save as PNG", () => save_picture(picture(), id));
  save.className = "icon-button small";
  save.append(icon("picture"));
  const head = make("header", "", make("b", "", title), save);
  const body = make("div", "plot-body");
  const card = make("article", "plot", head, legend, body);
  card.dataset.plot = id;
  return { card, legend, body };
}

// Puts the page's colour behind a picture, which is see-through on the page.
function save_picture(picture: HTMLCanvasElement, name: string): void {
  const copy = make("canvas");
  copy.width = picture.width;
  copy.height = picture.height;
  const context = copy.getContext("2d")!;
  context.fillStyle = css_color("--card");
  context.fillRect(0, 0, copy.width, copy.height);
  context.drawImage(picture, 0, 0);
  copy.toBlob((blob) => blob && download(blob, `${name}.png`));
}

export function css_color(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

export function hex_color(color: number): string {
  return `#${color.toString(16).padStart(6, "0")}`;
}

const SERIES_COLORS = 8;

export function series_color(index: number): string {
  return css_color(`--series-${(index % SERIES_COLORS) + 1}`);
}

// A canvas that fills `body`, in device pixels; drawing is in CSS pixels.
export class Surface {
  readonly canvas = make("canvas");
  width = 0;
  height = 0;

  constructor(private readonly body: HTMLElement) {
    body.append(this.canvas);
  }

  resize(): void {
    this.width = this.body.clientWidth;
    this.height = this.body.clientHeight;
    this.canvas.width = Math.round(this.width * devicePixelRatio);
    this.canvas.height = Math.round(this.height * devicePixelRatio);
    this.canvas.style.width = `${this.width}px`;
    this.canvas.style.height = `${this.height}px`;
  }

  // Empty, ready to draw.
  begin(): CanvasRenderingContext2D {
    if (this.width !== this.body.clientWidth || this.height !== this.body.clientHeight)
      this.resize();
    const context = this.canvas.getContext("2d")!;
    context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    context.clearRect(0, 0, this.width, this.height);
    context.font = PLOT_FONT;
    return context;
  }
}

export const PLOT_FONT = '11px system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif';
