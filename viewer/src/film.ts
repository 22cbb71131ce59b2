// A recording picture by picture, for `hapticgiant render`: `show=picture` in the address. Nothing is
// drawn by the clock: who renders asks for a time, and `draw` has resolved when its picture is there.

import { page_options } from "./data/token";
import type { Store } from "./data/store";
import type { Frame } from "./messages";
import { element, make, write } from "./page";
import { time_text } from "./text";

const PICTURES_PER_S = 60; // of a screen, on which some things move on from picture to picture
const SETTLED = 60; // pictures after which they rest
const SEEK_GAP_MS = 36; // the program takes 30 commands a second
const PATIENCE_MS = 180_000; // a large picture without graphics hardware may take long
const SAME_S = 2e-5; // times come rounded

interface Wanted {
  time_s: number;
  come(): void;
  fail(reason: Error): void;
}

export function is_film(): boolean {
  return page_options().get("show") === "picture";
}

export class Film {
  private readonly time = make("output", "film-time");
  private wanted: Wanted | null = null;
  private last_s: number | null = null;
  private last_seek_ms = -Infinity;

  // `prepare`: poses everything for the picture of the store's frame; `paint`: draws it.
  constructor(
    private readonly store: Store,
    private readonly prepare: (now_ms: number) => void,
    private readonly paint: () => void,
  ) {
    if (page_options().get("words") !== "none") element("stage-area").append(this.time);
    else document.body.dataset.words = "none";
    store.subscribe({
      on_frame: (frame) => this.take(frame),
      on_refusal: ({ reason }) => this.end((wanted) => wanted.fail(new Error(reason))),
    });
  }

  // Shows the recording's time `time_s` without drawing: so that trails and cameras have come there.
  async pass(time_s: number): Promise<void> {
    await this.seek(time_s);
    const gone_s = this.last_s === null ? Infinity : Math.abs(time_s - this.last_s);
    const pictures = Math.min(SETTLED, Math.max(1, Math.round(gone_s * PICTURES_PER_S)));
    for (let i = 1; i <= pictures; i++) this.prepare(1000 * time_s);
    this.last_s = time_s;
  }

  async draw(time_s: number): Promise<void> {
    await this.pass(time_s);
    write(this.time, time_text(time_s));
    this.paint();
    for (let i = 0; i < 2; i++) await new Promise(requestAnimationFrame); // it is on the screen
  }

  private async seek(time_s: number): Promise<void> {
    const pause_ms = this.last_seek_ms + SEEK_GAP_MS - performance.now();
    if (pause_ms > 0) await new Promise((resolve) => setTimeout(resolve, pause_ms));
    this.last_seek_ms = performance.now();
    await new Promise<void>((come, fail) => {
      const timer = setTimeout(() => fail(new Error(`no frame of ${time_s} s`)), PATIENCE_MS);
      this.wanted = { time_s, come: () => (clearTimeout(timer), come()), fail };
      if (!this.store.frame?.run_state.is_paused) this.store.commands.send("pause");
      this.store.commands.send("seek", "", time_s);
    });
  }

  private take({ run_state }: Frame): void {
    const { wanted } = this;
    if (!wanted || Math.abs(run_state.position_s - wanted.time_s) > SAME_S) return;
    if (run_state.is_paused) this.end(() => wanted.come());
  }

  private end(how: (wanted: Wanted) => void): void {
    const { wanted } = this;
    this.wanted = null;
    if (wanted) how(wanted);
  }
}
