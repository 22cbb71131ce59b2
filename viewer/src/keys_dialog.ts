// All keys of the page: opened by ? or its button. It does not cover the stop or take keys away from
// the page, so it is no modal dialog; Esc stops, as everywhere, and closes it.

import { LARGEST_N, RISE_N_PER_S } from "./hand/key_push";
import { element, is_typing, make, make_button } from "./page";

const PUSH = `${RISE_N_PER_S} N more for each second that the key is held, up to ${LARGEST_N} N; a released key lets go at once`;

const CAMERA: [string, string][] = [
  ["1 2 3 4", "camera: orbit, follow, top, first person"],
  ["V", "copy the camera, for hapticgiant render"],
];
const TOUCH = "By touch: drag the ring at the handle";
const TOUCH_CAMERA = "drag elsewhere to look around, two fingers to move and zoom";

const GROUPS: [string, [string, string][]][] = [
  [
    "Stop",
    [["Esc", "emergency stop, always"]],
  ],
  [
    "Hand",
    [
      ["W A S D or arrows", `push: away, left, towards you, right (${PUSH})`],
      ["Q E", "push down, up; while the mouse drags: turn left, right"],
      ["Space", "press the lever"],
      ["C", "clutch to a remote machine: open, close; open only while it is held for longer"],
      ["Shift or Z, X, Y, Alt", "while the mouse drags: up and down, along x, along y, turn"],
    ],
  ],
  [
    "Time and view",
    [
      ["P", "pause, continue"],
      [".", "one step"],
      ["R", "from the start"],
      ...CAMERA,
      ["?", "these keys"],
    ],
  ],
];

export class KeysDialog {
  private readonly dialog = element<HTMLDialogElement>("keys");
  private opened_from: Element | null = null;

  constructor(has_cameras: boolean) {
    const close = make_button("Close", "Esc stops the device as well", () => this.close());
    close.id = "close-keys";
    const title = make("h2", "", "Keys");
    title.id = "keys-title";
    const lists = GROUPS.flatMap(([name, all]) => {
      const keys = all.filter((key) => has_cameras || !CAMERA.includes(key));
      const rows = keys.flatMap(([key, what]) => [make("dt", "", key), make("dd", "", what)]);
      return [make("h3", "", name), make("dl", "", ...rows)];
    });
    const touch = make("p", "quiet", has_cameras ? `${TOUCH}; ${TOUCH_CAMERA}.` : `${TOUCH}.`);
    this.dialog.append(title, ...lists, touch, close);
    addEventListener("keydown", (event) => this.take_key(event));
  }

  toggle(): void {
    if (this.dialog.open) return this.close();
    this.opened_from = document.activeElement;
    this.dialog.show();
    element("close-keys").focus();
  }

  private close(): void {
    if (!this.dialog.open) return;
    this.dialog.close();
    if (this.opened_from instanceof HTMLElement) this.opened_from.focus();
  }

  private take_key(event: KeyboardEvent): void {
    if (event.key === "Escape") this.close();
    else if (event.key === "?" && !is_typing(event)) this.toggle();
  }
}
