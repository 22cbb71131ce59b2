// Counting values. Pure functions.

// How many values fall into each of `count` bins from 0 to `end`; larger ones into the last.
export function bins_of(values: ArrayLike<number>, count: number, end: number): number[] {
  const bins = new Array<number>(count).fill(0);
  for (let i = 0; i < values.length; i++) {
    const bin = Math.floor((values[i]! / end) * count);
    bins[Math.min(count - 1, Math.max(0, bin))]! += 1;
  }
  return bins;
}

export function quantile(values: Float64Array, share: number): number {
  const sorted = values.slice().sort();
  return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] ?? NaN;
}

export interface Span {
  from: number;
  to: number;
  state: number; // of the limit: -1 lower, 1 upper, 2 violated
}

// The times during which a limit acts.
export function spans_of(times: ArrayLike<number>, states: ArrayLike<number>): Span[] {
  const spans: Span[] = [];
  let open: Span | null = null;
  for (let i = 0; i < times.length; i++) {
    const state = states[i]!;
    if (open && open.state === state) {
      open.to = times[i]!;
      continue;
    }
    if (open) open.to = times[i]!;
    open =
      state === 0 || !Number.isFinite(state) ? null : { from: times[i]!, to: times[i]!, state };
    if (open) spans.push(open);
  }
  return spans;
}
