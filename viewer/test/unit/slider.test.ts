import { describe, expect, it } from "vitest";

import { number_text, place_of, value_at } from "../../src/panels/slider";

const narrow = { min: -1, max: 1, step: 0.1 };
const wide = { min: 0, max: 1000, step: 0.1 };

describe("slider", () => {
  it("reaches both ends and keeps to steps", () => {
    for (const range of [narrow, wide]) {
      expect(value_at(0, range)).toBe(range.min);
      expect(value_at(1, range)).toBe(range.max);
    }
    expect(value_at(0.52, narrow)).toBeCloseTo(0, 12);
  });

  it("comes back to the place of a value", () => {
    for (const value of [0.1, 1, 20, 700]) {
      expect(value_at(place_of(value, wide), wide)).toBeCloseTo(value, 6);
    }
    expect(place_of(5000, wide)).toBe(1);
  });

  it("gives small values of a wide range room", () => {
    expect(place_of(10, wide)).toBeGreaterThan(0.2);
    expect(place_of(0, narrow)).toBeCloseTo(0.5, 12);
  });

  it("shows few digits", () => {
    expect(number_text(0.1 + 0.2)).toBe("0.3");
    expect(number_text(1200)).toBe("1200");
  });
});
