// Says every 30 ms that this page is there. What it holds (enabling switch, override key) is let go
// by the program when nothing is heard for 100 ms: a page that is closed, hidden, stuck, or cut off
// holds nothing.

import type { Command, Hold } from "../messages";

const PERIOD_MS = 30;

export class Holder {
  private sequence = 0;
  private timer: ReturnType<typeof setInterval> | null = null;

  constructor(private readonly send: (hold: Hold) => boolean) {}

  // After a command has been sent: begins with the first switch that is taken.
  note({ command, value }: Command): void {
    if (command !== "panel" || value === 0) return;
    this.beat();
    this.timer ??= setInterval(() => this.beat(), PERIOD_MS);
  }

  // Until a switch is taken again.
  end(): void {
    if (this.timer !== null) clearInterval(this.timer);
    this.timer = null;
  }

  private beat(): void {
    this.send({ type: "hold", sequence: ++this.sequence });
  }
}
