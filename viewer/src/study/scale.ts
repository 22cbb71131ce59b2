// A scale between two ends: marks, values, and what a key does to an answer that may be missing.

import type { Item } from "./messages";

const MOST_MARKS = 25;
const PAGE_SHARE = 0.2; // of the scale

type Scale = Pick<Item, "low" | "high" | "step">;

export function count_of({ low, high, step }: Scale): number {
  return Math.floor((high - low) / step + 1e-9) + 1;
}

// Shares of the way, 0..1, at which a mark is drawn.
export function marks_of(scale: Scale): number[] {
  const count = count_of(scale);
  if (count > MOST_MARKS) return [0, 0.25, 0.5, 0.75, 1];
  return Array.from({ length: count }, (_, i) => (i * scale.step) / (scale.high - scale.low));
}

function tidy(value: number): number {
  return Number(value.toPrecision(12)); // 0.1 + 0.2
}

// The value of the scale nearest to the share `share` of the way.
export function value_at(scale: Scale, share: number): number {
  const { low, high, step } = scale;
  const index = Math.round((Math.min(1, Math.max(0, share)) * (high - low)) / step);
  return tidy(low + step * Math.min(count_of(scale) - 1, index));
}

export function share_of({ low, high }: Scale, value: number): number {
  return (value - low) / (high - low);
}

// The value after a key; null: the key means nothing here. A scale without an answer is entered from
// the end that the key comes from, so that no value is suggested.
export function value_after(scale: Scale, value: number | null, key: string): number | null {
  const { low, high, step } = scale;
  const last = tidy(low + step * (count_of(scale) - 1));
  const page = step * Math.max(1, Math.round((PAGE_SHARE * (high - low)) / step));
  const moved = (by: number): number => {
    if (value === null) return by > 0 ? low : last;
    return tidy(Math.min(last, Math.max(low, value + by)));
  };
  if (key === "ArrowRight" || key === "ArrowUp") return moved(step);
  if (key === "ArrowLeft" || key === "ArrowDown") return moved(-step);
  if (key === "PageUp") return moved(page);
  if (key === "PageDown") return moved(-page);
  if (key === "Home") return low;
  if (key === "End") return last;
  return null;
}
