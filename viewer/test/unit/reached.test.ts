import { expect, it } from "vitest";

import type { Event, SceneCheckpoint } from "../../src/messages";
import { reached_until } from "../../src/scene/reached";

const checkpoints = ["left", "right", "back"].map(
  (name): SceneCheckpoint => ({ name, x_m: 0, y_m: 0, azimuth_rad: 0 }),
);
const event = (name: string, time_s: number, run = 1): Event => ({ type: "event", run, time_s, name, text: "" });

it("counts the checkpoints up to the time that is shown", () => {
  const events = [event("left", 2), event("opened", 3), event("right", 5), event("back", 1, 2)];
  const scene = { run: 1, checkpoints };
  expect([0, 2, 4, 5, 9].map((time_s) => reached_until(scene, events, time_s))).toEqual([0, 1, 1, 2, 2]);
  expect(reached_until({ ...scene, run: 2 }, events, 9)).toBe(3); // the last one in its order
});
