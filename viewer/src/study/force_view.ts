// The force of the hand: a number, a bar, and its last seconds.

import { fill, make, write } from "../page";

const SHOWN_S = 20;
const FULL_N = 60; // of bar and plot, unless there was more
const [WIDTH, HEIGHT] = [280, 64];
const SVG = "http://www.w3.org/2000/svg";

export class ForceView {
  private readonly number = make("output", "number", "-");
  private readonly bar = make("div", "bar", make("i"));
  private readonly line = document.createElementNS(SVG, "polyline");
  private readonly most = make("small");
  private samples: { time_s: number; force_N: number }[] = [];

  constructor(root: HTMLElement) {
    const plot = document.createElementNS(SVG, "svg");
    plot.setAttribute("viewBox", `0 0 ${WIDTH} ${HEIGHT}`);
    plot.setAttribute("preserveAspectRatio", "none");
    plot.setAttribute("aria-hidden", "true");
    plot.append(this.line);
    this.bar.setAttribute("aria-hidden", "true");
    root.append(make("p", "", this.number, make("span", "unit", " N, force of the hand")), this.bar, plot as unknown as HTMLElement, this.most);
  }

  clear(): void {
    this.samples = [];
    this.draw(null);
  }

  show(time_s: number | null, force_N: number | null): void {
    const last = this.samples.at(-1);
    if (time_s !== null && last && time_s < last.time_s) this.samples = []; // another run
    if (time_s !== null && force_N !== null && time_s !== this.samples.at(-1)?.time_s) {
      this.samples.push({ time_s, force_N });
      this.samples = this.samples.filter((sample) => sample.time_s > time_s - SHOWN_S);
    }
    this.draw(force_N);
  }

  private draw(force_N: number | null): void {
    write(this.number, force_N === null ? "-" : force_N.toFixed(1));
    const most = Math.max(0, ...this.samples.map((sample) => sample.force_N));
    const full = Math.max(FULL_N, most);
    fill(this.bar, (force_N ?? 0) / full);
    const end_s = this.samples.at(-1)?.time_s ?? 0;
    const points = this.samples.map((sample) => {
      const x = WIDTH * (1 - (end_s - sample.time_s) / SHOWN_S);
      return `${x.toFixed(1)},${(HEIGHT - 2 - (HEIGHT - 4) * (sample.force_N / full)).toFixed(1)}`;
    });
    this.line.setAttribute("points", points.join(" "));
    const text = `last ${SHOWN_S} s, 0 to ${full.toFixed(0)} N, most ${most.toFixed(1)} N`;
    write(this.most, this.samples.length > 0 ? text : "");
  }
}
