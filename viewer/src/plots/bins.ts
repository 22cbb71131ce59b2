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

// At most about `most` of the rows from `first` to before `end`, and always the same ones while
// time advances: `first_row` rows have been forgotten. A line through other rows would flicker.
export function thinned_rows(
  first: number,
  end: number,
  first_row: number,
  most: number,
): number[] {
  const every = 2 ** Math.max(0, Math.ceil(Math.log2((end - first) / most)));
  const rows: number[] = [];
  const start = first + ((every - ((first_row + first) % every)) % every);
  for (let row = start; row < end; row += every) rows.push(row);
  if (end > first && rows.at(-1) !== end - 1) rows.push(end - 1); // the newest
  return rows;
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
