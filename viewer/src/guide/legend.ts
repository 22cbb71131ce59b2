// What the colours of the scene mean. A line is there while its layer is shown.

import { element, make } from "../page";
import { remember, remembered } from "../remembered";
import type { Layer, Layers } from "../scene/layers";
import {
  DEVICE_COLOR,
  ELBOW_COLOR,
  FORCE_COLOR,
  GHOST_COLOR,
  TORQUE_COLOR,
  TWIN_COLOR,
} from "../theme";

type Mark = "body" | "arrow" | "arc" | "line";

interface Line {
  layer: Layer;
  color: number;
  mark: Mark;
  text: string;
}

export const LEGEND: Line[] = [
  { layer: "device", color: DEVICE_COLOR, mark: "body", text: "robot (device)" },
  { layer: "twin", color: TWIN_COLOR, mark: "body", text: "twin" },
  { layer: "arrows", color: FORCE_COLOR, mark: "arrow", text: "force on the hand" },
  { layer: "arrows", color: TORQUE_COLOR, mark: "arc", text: "torque" },
  { layer: "trails", color: FORCE_COLOR, mark: "line", text: "way of the handle" },
  { layer: "trails", color: ELBOW_COLOR, mark: "line", text: "way of the elbow" },
  { layer: "ghost", color: GHOST_COLOR, mark: "body", text: "second recording" },
];

const STORED_AS = "hapticgiant.legend";
const STATES = ["open", "closed"] as const;

export class Legend {
  private readonly lines: [Line, HTMLElement][];
  private has_ghost = false;

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

  // `has_ghost`: a second recording is drawn through the first.
  show(has_ghost: boolean): void {
    if (this.has_ghost === has_ghost) return;
    this.has_ghost = has_ghost;
    this.apply_layers();
  }

  apply_layers(): void {
    for (const [{ layer }, item] of this.lines) {
      item.hidden = !this.layers.is_shown(layer) || (layer === "ghost" && !this.has_ghost);
    }
  }
}
