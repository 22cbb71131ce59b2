// What the colours of the scene mean. A line is there while its layer is shown.

import { element, make } from "../page";
import { remember, remembered } from "../remembered";
import type { Layer, Layers } from "../scene/layers";
import {
  BASE_COLOR,
  DEVICE_COLOR,
  ELBOW_COLOR,
  FORCE_COLOR,
  GHOST_COLOR,
  REMOTE_COLOR,
  TORQUE_COLOR,
  TWIN_COLOR,
} from "../theme";

type Mark = "body" | "target" | "arrow" | "arc" | "line";

interface Line {
  layer: Layer;
  color: number;
  mark: Mark;
  text: string;
}

export const LEGEND: Line[] = [
  { layer: "device", color: DEVICE_COLOR, mark: "body", text: "robot (device)" },
  { layer: "twin", color: TWIN_COLOR, mark: "body", text: "twin" },
  { layer: "base", color: BASE_COLOR, mark: "body", text: "what carries the twin" },
  { layer: "remote", color: REMOTE_COLOR, mark: "body", text: "remote machine" },
  { layer: "remote", color: REMOTE_COLOR, mark: "target", text: "where it is to be (ghost)" },
  { layer: "arrows", color: FORCE_COLOR, mark: "arrow", text: "force on the hand" },
  { layer: "arrows", color: TORQUE_COLOR, mark: "arc", text: "torque" },
  { layer: "trails", color: FORCE_COLOR, mark: "line", text: "way of the handle" },
  { layer: "trails", color: ELBOW_COLOR, mark: "line", text: "way of the elbow" },
  { layer: "ghost", color: GHOST_COLOR, mark: "body", text: "second recording" },
];

// What there is in some runs only: a second recording drawn through the first, a remote machine, a
// moving base of the twin.
type Shown = Record<"ghost" | "remote" | "base", boolean>;

const STORED_AS = "hapticgiant.legend";
const STATES = ["open", "closed"] as const;

export class Legend {
  private readonly lines: [Line, HTMLElement][];
  private shown: Shown = { ghost: false, remote: false, base: false };

  constructor(private readonly layers: Layers) {
    this.lines = LEGEND.map((line) => {
      const swatch = make("i");
      swatch.dataset.mark = line.mark;
      swatch.style.color = `#${line.color.toString(16).padStart(6, "0")}`;
      return [line, make("li", "", swatch, line.text)];
    });
    const list = make("ul", "", ...this.lines.map(([, item]) => item));
    const legend = make("details", "", make("summary", "", "Legend"), list);
    legend.id = "legend";
    legend.open = remembered(STORED_AS, STATES, innerWidth > 860 ? "open" : "closed") === "open";
    legend.addEventListener("toggle", () => remember(STORED_AS, legend.open ? "open" : "closed"));
    element("stage-area").append(legend);
    this.apply_layers();
  }

  show(shown: Shown): void {
    if (Object.entries(shown).every(([layer, is]) => this.shown[layer as keyof Shown] === is)) return;
    this.shown = shown;
    this.apply_layers();
  }

  apply_layers(): void {
    for (const [{ layer }, item] of this.lines) {
      const is_there = layer in this.shown ? this.shown[layer as keyof Shown] : true;
      item.hidden = !is_there || !this.layers.is_shown(layer);
    }
  }
}
