// Listens to the keys that push the hand.

import type { Scene } from "../messages";
import { is_typing } from "../page";
import type { Drag } from "./drag";
import type { HandView } from "./hand_view";
import { in_base, is_push_key, offset_of, push_of } from "./key_push";

// these move in their own lists and texts by arrows
const OWN_ARROWS = "input, select, textarea, [role=tab], [role=tabpanel], [data-scrolls]";

export class PushKeys {
  private readonly held = new Map<string, number>(); // since, ms
  private scene: Scene | null = null;

  constructor(
    private readonly drag: Drag,
    private readonly view: HandView,
  ) {
    addEventListener("keydown", (event) => this.press(event));
    addEventListener("keyup", (event) => this.lift(event));
    addEventListener("blur", () => this.clear());
    addEventListener("pagehide", () => this.clear());
    document.addEventListener("visibilitychange", () => document.hidden && this.clear());
  }

  load(scene: Scene): void {
    this.scene = scene;
    this.clear();
  }

  // A key that is still down pushes again only after it was released.
  clear(): void {
    this.held.clear();
    this.drag.set_push(null);
  }

  private press(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return this.clear(); // keys of the browser
    if (!is_push_key(event.code) || is_typing(event) || !this.is_ours(event)) return;
    event.preventDefault(); // nothing scrolls
    if (event.repeat || this.drag.is_dragging || this.held.has(event.code)) return;
    if (!this.drag.is_pushing) this.held.clear(); // held while the hand was let go
    this.held.set(event.code, performance.now());
    this.drag.set_push(() => this.offset());
    if (!this.drag.is_pushing) this.held.clear(); // refused
  }

  private lift({ code }: KeyboardEvent): void {
    if (!this.held.delete(code)) return;
    if (!this.drag.is_pushing) return this.held.clear(); // the hand was let go
    this.drag.set_push(this.held.size === 0 ? null : () => this.offset());
  }

  private is_ours({ code, target }: KeyboardEvent): boolean {
    const is_arrow = code.startsWith("Arrow");
    return !(is_arrow && target instanceof HTMLElement && target.matches(OWN_ARROWS));
  }

  private offset(): [number, number, number] {
    if (!this.scene) return [0, 0, 0];
    const force = in_base(push_of(this.held, performance.now()), this.view.direction());
    return offset_of(force, this.scene.hand_stiffness_N_per_m, this.scene.hand_force_max_N);
  }
}
