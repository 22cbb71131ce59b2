// Keeps the picture fluent on slow graphics: when drawing takes long, first fewer pixels, then no
// shadows, then fewer pixels still. Never goes back up, so that nothing flickers.

const SLOW_MS = 45; // slower than 22 pictures per second
const PATIENCE_MS = 700;
const PAUSE_MS = 1500; // a hidden tab is not a slow one

const LOWEST = 3; // level

export type Wish = "best" | "fast" | null;

export class Quality {
  private level: number;
  private slow_ms = 0; // how long it has been slow
  private last_ms: number | null = null;

  // `best`: the best picture, however long it takes; `fast`: the cheapest one from the start.
  constructor(private readonly wish: Wish = null) {
    this.level = wish === "fast" ? LOWEST : 0;
  }

  // Smooth edges and reflections: they are there from the start, or never.
  get is_fine(): boolean {
    return this.wish !== "fast";
  }

  get has_shadows(): boolean {
    return this.level < 2;
  }

  pixel_ratio(of_screen: number): number {
    if (this.level === 0) return Math.min(2, of_screen);
    return this.level < LOWEST ? 1 : 0.6;
  }

  // Notes the time of a picture; true when the quality has changed.
  observe(now_ms: number): boolean {
    const elapsed_ms = this.last_ms === null ? 0 : now_ms - this.last_ms;
    this.last_ms = now_ms;
    const is_slow = elapsed_ms > SLOW_MS && elapsed_ms < PAUSE_MS;
    this.slow_ms = is_slow ? this.slow_ms + elapsed_ms : 0;
    if (this.wish === "best" || this.slow_ms < PATIENCE_MS || this.level === LOWEST) return false;
    this.level += 1;
    this.slow_ms = 0;
    return true;
  }
}
