import { expect, it } from "vitest";

import { Trail } from "../../src/scene/trail";

it("a trail that is cleared begins where the point is now", () => {
  const trail = new Trail(0xff0000);
  for (const x of [0, 0.1, 0.2]) trail.add([x, 0, 0]);
  expect(trail.line.geometry.drawRange.count).toBe(3);
  trail.clear();
  expect(trail.line.geometry.drawRange.count).toBe(0);
  trail.add([0.3, 0, 0]);
  expect(trail.line.geometry.drawRange.count).toBe(1);
});
