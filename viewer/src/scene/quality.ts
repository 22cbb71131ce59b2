// Keeps the picture fluent on slow graphics: when drawing takes long, first fewer pixels, then no
// shadows, then fewer pixels still. Never goes back up, so that nothing flickers.

const SLOW_MS = 45; // slower than 22 pictures per second
const PATIENCE_MS = 700;
const PAUSE_MS = 1500; // a hidden tab is not a slow one

export class Quality {
  private level = 0;
  private slow_ms = 0; // how long it has been slow
  private last_ms: number | null = null;

  // `is_fixed`: the best picture, however long it takes.
  constructor(private readonly is_fixed = false) {}

  get has_shadows(): boolean {
    return this.level < 2;
  }

  pixel_ratio(of_screen: number): number {
    if (this.level === 0) return Math.min(2, of_screen);
    return this.level < 3 ? 1 : 0.6;
  }

  // Notes the time of a picture; true when the quality has changed.
  observe(now_ms: number): boolean {
    const elapsed_ms = this.last_ms === null ? 0 : now_ms - this.last_ms;
    this.last_ms = now_ms;
    const is_slow = elapsed_ms > SLOW_MS && elapsed_ms < PAUSE_MS;
    this.slow_ms = is_slow ? this.slow_ms + elapsed_ms : 0;
    if (this.is_fixed || this.slow_ms < PATIENCE_MS || this.level === 3) return false;
    this.level += 1;
    this.slow_ms = 0;
    return true;
  }
}
