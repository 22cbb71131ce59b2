// What of the scene can be switched on and off; remembered by the browser.

export const LAYERS = {
  device: { title: "Device", is_on: true },
  twin: { title: "Twin", is_on: true },
  remote: { title: "Remote machine", is_on: true },
  ghost: { title: "Second recording", is_on: true },
  base: { title: "Base of the twin", is_on: true },
  surfaces: { title: "Virtual surfaces", is_on: true },
  checkpoints: { title: "Checkpoints", is_on: true },
  surroundings: { title: "Surroundings", is_on: true },
  person: { title: "Person", is_on: true },
  arrows: { title: "Force and torque", is_on: true },
  limits: { title: "Joint limits", is_on: true },
  torques: { title: "Joint torques", is_on: true },
  trails: { title: "Trails of handle and elbow", is_on: true },
  box: { title: "Box of the handle", is_on: true },
  shapes: { title: "Self-collision shapes", is_on: false },
  scanner: { title: "Scanner zone (only drawn)", is_on: false },
} as const;

export type Layer = keyof typeof LAYERS;
export const LAYER_NAMES = Object.keys(LAYERS) as Layer[];

const STORED_AS = "hapticgiant.layers";

export class Layers {
  private readonly shown: Record<Layer, boolean>;

  constructor(private readonly on_change: () => void) {
    const start = Object.fromEntries(LAYER_NAMES.map((name) => [name, LAYERS[name].is_on]));
    this.shown = { ...start, ...stored() } as Record<Layer, boolean>;
  }

  is_shown(layer: Layer): boolean {
    return this.shown[layer];
  }

  show(layer: Layer, is_shown: boolean): void {
    this.shown[layer] = is_shown;
    localStorage.setItem(STORED_AS, JSON.stringify(this.shown));
    this.on_change();
  }
}

function stored(): Partial<Record<Layer, boolean>> {
  try {
    return JSON.parse(localStorage.getItem(STORED_AS) ?? "{}");
  } catch {
    return {};
  }
}
