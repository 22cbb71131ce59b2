// Short notes over the scene: refusals and messages that could not be read.

import { element, make } from "../page";

const SHOWN_MS = 7000;
const MOST = 3;

export class Notices {
  private readonly list = element("notices");
  private readonly by_key = new Map<string, { item: HTMLElement; timer: number }>();

  // A note with the same key replaces the one before.
  show(key: string, text: string): void {
    this.remove(key);
    const item = make("li", "", text);
    this.list.append(item);
    this.by_key.set(key, { item, timer: window.setTimeout(() => this.remove(key), SHOWN_MS) });
    if (this.by_key.size > MOST) this.remove(this.by_key.keys().next().value!);
  }

  private remove(key: string): void {
    const known = this.by_key.get(key);
    if (!known) return;
    clearTimeout(known.timer);
    known.item.remove();
    this.by_key.delete(key);
  }
}
