import { BoxGeometry, SphereGeometry } from "three";
import { describe, expect, it } from "vitest";

import { hull_of, outer_points } from "../../src/picture/outline";
import { SIDE, TOP, area_of, fitted, projected, unprojected } from "../../src/picture/projection";
import type { Vec3 } from "../../src/messages";

describe("outlines", () => {
  it("of points are their convex hull", () => {
    const hull = hull_of([[0, 0], [2, 0], [1, 0.5], [2, 2], [0, 2], [1, 1], [1, 0]]);
    expect(hull).toHaveLength(4);
    expect(hull).toEqual(expect.arrayContaining([[0, 0], [2, 0], [2, 2], [0, 2]]));
  });

  it("keep what stands out of a shape, with few points", () => {
    expect(outer_points(new BoxGeometry(1, 2, 3))).toHaveLength(8);
    const ball = outer_points(new SphereGeometry(1, 64, 64));
    expect(ball.length).toBeLessThan(60);
    expect(Math.max(...ball.map(({ x }) => x))).toBeCloseTo(1, 3);
  });
});

describe("flat views", () => {
  const points: Vec3[] = [[-1, -2, 0], [3, 2, 1]];

  it.each([SIDE, TOP])("show all points and find them again: $name", (facing) => {
    const view = fitted(facing, area_of(facing, points, 0.5), 400, 300);
    for (const p of points) {
      const [x, y] = projected(view, p);
      expect(x >= 0 && x <= 400 && y >= 0 && y <= 300).toBe(true);
      const back = projected(view, unprojected(view, [x, y]));
      expect(back[0]).toBeCloseTo(x);
      expect(back[1]).toBeCloseTo(y);
    }
  });

  it("have up at the top and the right hand at the right", () => {
    const view = fitted(SIDE, area_of(SIDE, points, 0.5), 400, 300);
    expect(projected(view, [0, 0, 1])[1]).toBeLessThan(projected(view, [0, 0, 0])[1]);
    expect(projected(view, [1, 0, 0])[0]).toBeGreaterThan(projected(view, [0, 0, 0])[0]);
  });
});
