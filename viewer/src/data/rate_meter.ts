// Counts how often something happened during the last second.

export class RateMeter {
  private times_s: number[] = [];

  tick(now_s: number): void {
    this.times_s.push(now_s);
    this.forget(now_s);
  }

  per_second(now_s: number): number {
    this.forget(now_s);
    return this.times_s.length;
  }

  private forget(now_s: number): void {
    while (this.times_s.length > 0 && this.times_s[0]! <= now_s - 1) this.times_s.shift();
  }
}
