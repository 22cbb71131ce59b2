import { describe, expect, it } from "vitest";

import { position_of } from "../../src/scene/follower";

const crank = { joint: "rocker", leader: "crank", is_periodic: false, values: [0, 1, 3] };

describe("a joint of a closed loop", () => {
  it("is between the values that are given", () => {
    const follower = { ...crank, begin: -1, end: 1 };
    expect(position_of(follower, -0.5)).toBeCloseTo(0.5);
    expect(position_of(follower, 0.75)).toBeCloseTo(2.5);
  });

  it("stands still beyond the range of its leader", () => {
    const follower = { ...crank, begin: -1, end: 1 };
    expect(position_of(follower, -2)).toBe(0);
    expect(position_of(follower, 1.5)).toBe(3);
  });

  it("begins again after a turn of a crank", () => {
    const follower = { ...crank, begin: -Math.PI, end: Math.PI, is_periodic: true };
    expect(position_of(follower, 7 + 4 * Math.PI)).toBeCloseTo(position_of(follower, 7 - 2 * Math.PI));
  });
});
