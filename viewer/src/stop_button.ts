// The emergency stop in the bar: pressed by click or Esc, wherever the focus is. It only presses;
// the way back is in the tab Safety, so that a hand that hits it twice does not release it.

import type { Commands } from "./data/commands";
import type { Link } from "./data/freshness";
import type { Safety, Scene } from "./messages";
import { element, write } from "./page";

interface StopText {
  text: string;
  note: string;
  announcement: string;
}

// Who presses it, in words.
export function presser_text(page: number, own_page: number): string {
  if (page === own_page) return "this page";
  return page === 0 ? "the script" : `page ${page}`;
}

export function stop_text(link: Link, safety: Safety | null, own_page: number): StopText {
  if (link === "lost") {
    return {
      text: "STOP",
      note: "cannot reach the device",
      announcement: "No connection: the emergency stop cannot reach the device.",
    };
  }
  if (safety?.emergency_stop) {
    const by = safety.stop_pressed_by.map((page) => presser_text(page, own_page)).join(", ");
    return {
      text: "STOPPED",
      note: by === "" ? "see Safety" : `by ${by}`,
      announcement: `Emergency stop pressed${by === "" ? "" : ` by ${by}`}.`,
    };
  }
  if (link === "silent") {
    return {
      text: "STOP",
      note: "may not reach the device",
      announcement: "No data: the emergency stop may not reach the device.",
    };
  }
  return { text: "STOP", note: "Esc", announcement: "" };
}

// A page that shows this one inside itself presses the stop by a message.
export function is_stop_of_container(source: unknown, data: unknown): boolean {
  return window.parent !== window && source === window.parent && data === "emergency stop";
}

export class StopButton {
  private readonly button = element<HTMLButtonElement>("emergency-stop");
  private readonly announcement = element("stop-announcement");
  private is_pressed = false;

  constructor(
    private readonly commands: Commands,
    private readonly show_safety: () => void,
  ) {
    this.button.addEventListener("click", () => this.press());
    const take_key = (event: KeyboardEvent): void => {
      if (event.key !== "Escape" || event.repeat || this.button.hidden) return;
      event.preventDefault();
      this.press();
    };
    addEventListener("keydown", take_key, { capture: true }); // before anything else takes it
    addEventListener("message", ({ source, data }) => {
      if (is_stop_of_container(source, data) && !this.button.hidden) this.press();
    });
  }

  load(scene: Scene): void {
    this.button.hidden = !scene.commands.includes("emergency_stop");
  }

  show(link: Link, safety: Safety | null, own_page: number): void {
    const { text, note, announcement } = stop_text(link, safety, own_page);
    this.is_pressed = safety?.emergency_stop ?? false;
    write(element("stop-text"), text);
    write(element("stop-note"), note);
    this.button.dataset.link = link;
    this.button.setAttribute("aria-pressed", String(this.is_pressed));
    write(this.announcement, this.button.hidden ? "" : announcement);
  }

  private press(): void {
    this.commands.send("emergency_stop"); // again, too: what is shown may be old
    if (this.is_pressed) this.show_safety();
  }
}
