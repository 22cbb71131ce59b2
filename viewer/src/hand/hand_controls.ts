// Keys and buttons of the hand, and the ring that says where the handle is.

import type { Scene } from "../messages";
import { element, is_typing, make, make_button, make_check_box, write } from "../page";
import type { Drag, DragMode } from "./drag";
import type { Pixel } from "./hand_view";
import { hand_words } from "./hand_words";

const MODES: ["plane" | "z" | "turn", string][] = [
  ["plane", "Dragging moves the hand in the level plane"],
  ["z", "Dragging moves the hand up and down (hold Shift or Z)"],
  ["turn", "Dragging turns the hand (hold Alt); the wheel, Q and E turn it while it is dragged"],
];
const KEYS: Record<string, DragMode> = {
  Shift: "z",
  z: "z",
  x: "x",
  y: "y",
  Alt: "turn",
};

const SPINS: Record<string, number> = { q: 1, e: -1 }; // turn while dragging, as the wheel does

const OWN_SPACE = "button, summary, input"; // the space bar works them
const LABEL_AWAY = 26; // px, from the handle

function has_lever(scene: Scene): boolean {
  return scene.twin.joints.some((joint) => /lever|handle|latch/i.test(joint.name));
}

export function grip_text(scene: Scene): string {
  const words = hand_words();
  if (has_lever(scene)) return words.door;
  return scene.environment === "excavator" ? words.dig : words.me;
}

// The side of the handle at `x` where its label is not cut off by the edge of the scene, px.
export function label_side(x: number, label_width: number, width: number): "left" | "right" {
  const fits = x + LABEL_AWAY + label_width <= width;
  return fits || x < 0.5 * width ? "right" : "left";
}

export class HandControls {
  private readonly buttons = new Map<DragMode, HTMLButtonElement>();
  private readonly press_part: HTMLElement;
  private readonly press_button: HTMLButtonElement;
  private readonly automatic: HTMLInputElement;

  constructor(private readonly drag: Drag) {
    const modes = make("span", "buttons");
    const words = hand_words();
    for (const [mode, title] of MODES) {
      const button = make_button(words[mode], title, () => (drag.chosen_mode = mode));
      button.id = `drag-${mode}`;
      this.buttons.set(mode, button);
      modes.append(button);
    }
    this.press_button = make("button", "", words.press);
    this.press_button.type = "button";
    this.press_button.id = "press";
    this.press_button.title = "Pushes the lever down (Space)";
    const automatic = make_check_box(words.automatic, true, (is_checked) => {
      drag.presses_while_dragging = is_checked;
    });
    this.automatic = automatic.querySelector("input")!;
    this.press_part = make("span", "buttons", this.press_button, automatic);
    element("hand").replaceChildren(make("span", "quiet", words.drag), modes, this.press_part);
    this.connect_press();
    addEventListener("keydown", (event) => this.take_key(event, true));
    addEventListener("keyup", (event) => this.take_key(event, false));
  }

  load(scene: Scene): void {
    const lever = has_lever(scene);
    this.press_part.hidden = !lever;
    this.automatic.checked = this.drag.presses_while_dragging = lever;
    write(element("grip-text"), grip_text(scene));
  }

  // `force_N`: shown at the handle while it is held.
  show(handle_px: Pixel | null, force_N: number): void {
    const grip = element("grip");
    grip.hidden = handle_px === null;
    if (handle_px) {
      const area = grip.parentElement!.getBoundingClientRect();
      const [x, y] = [handle_px.x - area.left, handle_px.y - area.top];
      grip.dataset.side = label_side(x, element("grip-text").offsetWidth, area.width);
      grip.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    }
    const is_held = this.drag.is_dragging || this.drag.is_pushing;
    grip.dataset.held = String(is_held);
    if (is_held) {
      grip.dataset.known = "true"; // the label has done its work
      write(element("grip-text"), `${force_N.toFixed(0)} N`);
    }
    this.press_button.setAttribute("aria-pressed", String(this.drag.press > 0));
    for (const [mode, button] of this.buttons) {
      button.setAttribute("aria-pressed", String(this.drag.mode === mode));
    }
  }

  private connect_press(): void {
    this.press_button.addEventListener("pointerdown", (event) => {
      this.press_button.setPointerCapture(event.pointerId);
      this.drag.set_pressing(true);
    });
    this.press_button.addEventListener("lostpointercapture", () => this.drag.set_pressing(false));
  }

  private take_key(event: KeyboardEvent, is_down: boolean): void {
    if (is_down && is_typing(event)) return;
    if (
      event.code === "Space" &&
      !(event.target instanceof HTMLElement && event.target.matches(OWN_SPACE))
    ) {
      event.preventDefault();
      this.drag.set_pressing(is_down);
    }
    if (is_down && event.key in SPINS) this.drag.spin(SPINS[event.key]!);
    const mode = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (mode === undefined) return;
    if (event.key === "Alt") event.preventDefault(); // the browser's menu
    if (is_down) this.drag.key_mode = mode;
    else if (this.drag.key_mode === mode) this.drag.key_mode = null;
  }
}
