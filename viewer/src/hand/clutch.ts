// The clutch to a remote machine: key C and a button beside the hand. A short press opens or closes
// it; a longer one opens it only while the key or button is held. Only the page that has the hand,
// or may take it, works it.

import type { Commands } from "../data/commands";
import type { Frame, Scene } from "../messages";
import { element, is_typing, make, write } from "../page";
import { clutch_text } from "../remote_text";

const LONG_MS = 400; // a press that is held
const KEY = "c";

export class Clutch {
  private readonly button = make("button");
  private readonly text = make("span");
  private pressed_ms: number | null = null; // when the present press has opened it
  private is_offered = false;
  private can_hold = false;

  constructor(
    private readonly commands: Commands,
    private readonly frame: () => Frame | null,
  ) {
    this.button.type = "button";
    this.button.id = "clutch";
    this.button.setAttribute("aria-keyshortcuts", "C");
    this.button.title = "Opens and closes the clutch (C): while it is open, your hand moves without the remote machine";
    this.button.append(this.text, make("span", "key", " (C)"));
    this.button.hidden = true;
    element("hand").append(this.button);
    this.button.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      this.button.setPointerCapture(event.pointerId);
      this.press();
    });
    this.button.addEventListener("lostpointercapture", () => this.lift());
    this.button.addEventListener("click", (event) => {
      if (event.detail === 0) this.toggle(); // by Enter, Space or a screen reader
    });
    addEventListener("keydown", (event) => this.take_key(event));
    addEventListener("keyup", (event) => event.key.toLowerCase() === KEY && this.lift());
    addEventListener("blur", () => this.lift());
  }

  load(scene: Scene): void {
    this.is_offered = scene.teleoperation !== null && scene.commands.includes("clutch");
    this.button.hidden = !this.is_offered;
    this.pressed_ms = null;
  }

  // `can_hold`: no other page has the hand.
  show({ teleoperation }: Frame, can_hold: boolean): void {
    this.can_hold = can_hold;
    if (!this.is_offered || !teleoperation) return;
    const text = clutch_text(teleoperation);
    write(this.text, text);
    this.button.dataset.state = teleoperation.link;
    const label = `${text} (C). Opens and closes the clutch to the remote machine`;
    if (this.button.ariaLabel !== label) this.button.ariaLabel = label;
  }

  private get is_open(): boolean {
    return this.frame()?.teleoperation?.is_clutch_open ?? false;
  }

  private toggle(): void {
    this.send(!this.is_open);
  }

  private press(): void {
    if (this.is_open) return this.send(false);
    this.send(true);
    this.pressed_ms = performance.now();
  }

  private lift(): void {
    const pressed_ms = this.pressed_ms;
    this.pressed_ms = null;
    if (pressed_ms !== null && performance.now() - pressed_ms > LONG_MS) this.send(false);
  }

  private send(is_open: boolean): void {
    this.commands.send("clutch", "", is_open ? 1 : 0);
  }

  private take_key(event: KeyboardEvent): void {
    if (event.key.toLowerCase() !== KEY || event.repeat || is_typing(event)) return;
    if (event.ctrlKey || event.metaKey || event.altKey || !this.is_offered || !this.can_hold) return;
    this.press();
  }
}
