// Whether what is shown is still so. Counts ticks instead of time: a page that was stuck itself has
// frames waiting that it has not read.

export const TICK_MS = 100;
const PATIENCE_TICKS = 5;

export type Link = "open" | "silent" | "lost"; // silent: connected, but nothing comes

export class Freshness {
  private ticks = 0;

  note(): void {
    this.ticks = 0;
  }
  tick(): void {
    this.ticks += 1;
  }
  // `is_expected`: time advances in the program, so that frames have to come.
  link(is_connected: boolean, is_expected: boolean): Link {
    if (!is_connected) return "lost";
    return is_expected && this.ticks >= PATIENCE_TICKS ? "silent" : "open";
  }
}
