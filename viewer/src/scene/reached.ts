import type { Event, Scene } from "../messages";

// How many of the checkpoints, which have an order, were reached up to this time. The page of a
// recording has all its events from the start.
export function reached_until(
  { run, checkpoints }: Pick<Scene, "run" | "checkpoints">,
  events: readonly Event[],
  time_s: number,
): number {
  const names = events.filter((event) => event.run === run && event.time_s <= time_s).map(({ name }) => name);
  return checkpoints.map(({ name }) => names.includes(name)).lastIndexOf(true) + 1;
}
