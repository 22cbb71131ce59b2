// The bar of a recording: where in it one is, and the way to another place.

import type { Store } from "./data/store";
import type { Frame, Scene } from "./messages";
import { element, make, write } from "./page";
import { hex_color } from "./plots/plot";
import { time_text } from "./text";
import { GHOST_COLOR } from "./theme";

const SEEK_GAP_MS = 60;

function end_of(scene: Scene): number {
  return scene.begin_s + scene.duration_s;
}

export class ReplayBar {
  private readonly part = element("replay");
  private readonly slider = make("input");
  private readonly time = make("output");
  private readonly name = make("span", "quiet");
  private readonly ghost = make("span", "ghost", make("i"), "second recording");
  private last_seek_ms = 0;
  private is_scrubbing = false;

  constructor(private readonly store: Store) {
    this.slider.type = "range";
    this.slider.id = "scrub";
    this.slider.step = "any";
    this.slider.setAttribute("aria-label", "Place in the recording");
    (this.ghost.firstElementChild as HTMLElement).style.background = hex_color(GHOST_COLOR);
    this.part.append(this.time, this.slider, this.name, this.ghost);
    this.slider.addEventListener("input", () => {
      this.is_scrubbing = true;
      if (performance.now() - this.last_seek_ms > SEEK_GAP_MS) this.seek();
    });
    this.slider.addEventListener("change", () => this.seek());
    for (const end of ["change", "pointerup", "pointercancel", "keyup", "blur"]) {
      this.slider.addEventListener(end, () => (this.is_scrubbing = false));
    }
  }

  load(scene: Scene): void {
    this.part.hidden = scene.source !== "recording";
    this.slider.min = String(scene.begin_s);
    this.slider.max = String(end_of(scene));
    this.slider.disabled = !scene.commands.includes("seek");
  }

  show(scene: Scene, frame: Frame): void {
    if (scene.source !== "recording") return;
    const { position_s, recording } = frame.run_state;
    if (!this.is_scrubbing) this.slider.value = String(position_s);
    write(this.time, `${time_text(position_s)} / ${time_text(end_of(scene))}`);
    write(this.name, recording);
    this.ghost.hidden = frame.ghost === null;
  }

  private seek(): void {
    this.last_seek_ms = performance.now();
    this.store.commands.send("seek", "", Number(this.slider.value));
  }
}
