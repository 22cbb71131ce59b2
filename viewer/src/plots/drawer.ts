// The drawer with plots at the bottom: which are shown, which time, export.

import type { Store } from "../data/store";
import { icon } from "../icons";
import type { Scene } from "../messages";
import { download, make, make_button } from "../page";
import { remember, remembered } from "../remembered";
import { on_theme_change } from "../theme";
import { Histogram } from "./histogram";
import { LimitLines } from "./limit_lines";
import type { Plot, TimeRange } from "./plot";
import { time_specs } from "./specs";
import { TimePlot } from "./time_plot";
import { TopView } from "./top_view";

const STORED_AS = "hapticgiant.plots";
const OPEN_AS = "hapticgiant.plots_are";
const FIRST_SHOWN = ["force", "twin", "twin-position", "limits", "top-view"];
const LIVE_S = 20;
const [SHORTEST_S, LONGEST_S] = [1, 120];
const SHORTEST_HELD_S = 0.02;
const [LOWEST_PX, HIGHEST_SHARE] = [140, 0.75];

interface Offer {
  id: string;
  title: string;
  make: () => Plot;
}

export class PlotDrawer {
  private readonly chips = make("div", "chips");
  private readonly grid = make("div", "plot-grid");
  private readonly pause_button: HTMLButtonElement;
  private offers: Offer[] = [];
  private shown = new Set<string>(stored_choice());
  private plots = new Map<string, Plot>();
  private live_s = LIVE_S; // shown while time advances
  private held: TimeRange | null = null; // shown while it stands still

  constructor(
    private readonly part: HTMLElement,
    private readonly store: Store,
  ) {
    part.hidden = remembered(OPEN_AS, ["shown", "hidden"], "hidden") === "hidden";
    this.pause_button = make_button("pause", "Plots are paused; double click continues", () => {
      this.hold(this.held ? null : this.range);
    });
    this.pause_button.id = "hold-plots";
    const csv = make_button("CSV", "Save all numbers of the shown time", () => this.save_csv());
    csv.prepend(icon("table"));
    csv.className = "with-icon";
    csv.id = "save-csv";
    const edge = make("div", "drawer-edge");
    const tools = make("span", "buttons", this.pause_button, csv);
    part.append(edge, make("header", "", this.chips, tools), this.grid);
    this.connect_edge(edge);
    this.grid.addEventListener("wheel", (event) => this.zoom(event), { passive: false });
    this.grid.addEventListener("dblclick", () => this.hold(null));
    new ResizeObserver(() => this.resize()).observe(this.grid);
    on_theme_change(() => this.rebuild());
  }

  get is_shown(): boolean {
    return !this.part.hidden;
  }

  toggle(): boolean {
    this.part.hidden = !this.part.hidden;
    remember(OPEN_AS, this.part.hidden ? "hidden" : "shown");
    this.rebuild();
    return this.is_shown;
  }

  load(scene: Scene): void {
    const zoom = (range: TimeRange): void => this.hold(range);
    this.offers = [
      ...time_specs(scene).map((spec) => ({
        id: spec.id,
        title: spec.title,
        make: () => new TimePlot(spec, zoom),
      })),
      { id: "limits", title: "Limits", make: () => new LimitLines() },
      { id: "top-view", title: "From above", make: () => new TopView(scene) },
      { id: "cycle-time", title: "Cycle time", make: () => new Histogram() },
    ];
    this.chips.replaceChildren(...this.offers.map((offer) => this.chip(offer)));
    this.hold(null);
    this.rebuild();
  }

  show(): void {
    const { scene, history } = this.store;
    if (this.part.hidden || !scene || history.length === 0) return;
    for (const plot of this.plots.values()) plot.draw({ scene, history, range: this.range });
  }

  private get range(): TimeRange {
    if (this.held) return this.held;
    const { history } = this.store;
    const to = Math.max(history.length > 0 ? history.last("time_s") : 0, this.live_s);
    return { from: to - this.live_s, to };
  }

  private hold(range: TimeRange | null): void {
    this.held = range;
    this.pause_button.setAttribute("aria-pressed", String(range !== null));
    this.show();
  }

  private zoom(event: WheelEvent): void {
    if (!(event.target instanceof HTMLElement) || !event.target.closest(".plot-body")) return;
    event.preventDefault();
    const factor = Math.exp(0.0012 * event.deltaY);
    if (!this.held) {
      this.live_s = Math.min(LONGEST_S, Math.max(SHORTEST_S, this.live_s * factor));
    } else {
      const { from, to } = this.held;
      const span = Math.min(LONGEST_S, Math.max(SHORTEST_HELD_S, (to - from) * factor));
      const area = event.target.getBoundingClientRect();
      const share = (event.clientX - area.left) / area.width;
      const start = from + share * (to - from - span);
      this.hold({ from: start, to: start + span });
    }
    this.show();
  }

  private chip({ id, title }: Offer): HTMLButtonElement {
    const chip = make_button(title, `Show or hide ${title}`, () => {
      if (!this.shown.delete(id)) this.shown.add(id);
      localStorage.setItem(STORED_AS, JSON.stringify([...this.shown]));
      chip.setAttribute("aria-pressed", String(this.shown.has(id)));
      this.rebuild();
    });
    chip.className = "chip";
    chip.dataset.plot = id;
    chip.setAttribute("aria-pressed", String(this.shown.has(id)));
    return chip;
  }

  private rebuild(): void {
    for (const plot of this.plots.values()) plot.dispose();
    this.plots.clear();
    if (this.part.hidden) return;
    const offers = this.offers.filter(({ id }) => this.shown.has(id));
    for (const offer of offers) this.plots.set(offer.id, offer.make());
    this.grid.replaceChildren(...[...this.plots.values()].map(({ card }) => card));
    this.resize();
    this.show();
  }

  private resize(): void {
    for (const plot of this.plots.values()) plot.resize();
  }

  private save_csv(): void {
    download(new Blob([this.store.history.csv()], { type: "text/csv" }), "hapticgiant.csv");
  }

  // Dragging the upper edge makes the drawer higher or lower.
  private connect_edge(edge: HTMLElement): void {
    edge.addEventListener("pointerdown", (event) => edge.setPointerCapture(event.pointerId));
    edge.addEventListener("pointermove", (event) => {
      if (!edge.hasPointerCapture(event.pointerId)) return;
      const wanted = this.part.getBoundingClientRect().bottom - event.clientY;
      const height = Math.min(HIGHEST_SHARE * innerHeight, Math.max(LOWEST_PX, wanted));
      this.part.style.height = `${height}px`;
    });
  }
}

function stored_choice(): string[] {
  try {
    return JSON.parse(localStorage.getItem(STORED_AS) ?? "null") ?? FIRST_SHOWN;
  } catch {
    return FIRST_SHOWN;
  }
}
