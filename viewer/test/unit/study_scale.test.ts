import { describe, expect, it } from "vitest";

import { count_of, marks_of, share_of, value_after, value_at } from "../../src/study/scale";

const TLX = { low: 0, high: 100, step: 5 };

describe("the scale of the TLX", () => {
  it("has 21 marks from end to end", () => {
    expect(count_of(TLX)).toBe(21);
    expect(marks_of(TLX)).toHaveLength(21);
    expect([marks_of(TLX)[0], marks_of(TLX)[10], marks_of(TLX)[20]]).toEqual([0, 0.5, 1]);
  });

  it("takes the mark nearest to a finger, also beyond its ends", () => {
    expect([-1, 0, 0.024, 0.026, 0.5, 0.99, 3].map((share) => value_at(TLX, share))).toEqual([
      0, 0, 0, 5, 50, 100, 100,
    ]);
    expect(share_of(TLX, 35)).toBeCloseTo(0.35, 12);
  });

  it("is entered from the end a key comes from: no value is suggested", () => {
    expect(value_after(TLX, null, "ArrowRight")).toBe(0);
    expect(value_after(TLX, null, "ArrowUp")).toBe(0);
    expect(value_after(TLX, null, "ArrowLeft")).toBe(100);
    expect(value_after(TLX, null, "PageDown")).toBe(100);
  });

  it("moves by one mark, by a fifth, to the ends, and not beyond", () => {
    expect(value_after(TLX, 50, "ArrowRight")).toBe(55);
    expect(value_after(TLX, 50, "ArrowDown")).toBe(45);
    expect(value_after(TLX, 50, "PageUp")).toBe(70);
    expect(value_after(TLX, 95, "PageUp")).toBe(100);
    expect(value_after(TLX, 0, "ArrowLeft")).toBe(0);
    expect(value_after(TLX, 50, "Home")).toBe(0);
    expect(value_after(TLX, 50, "End")).toBe(100);
    expect(value_after(TLX, 50, "Tab")).toBeNull();
    expect(value_after(TLX, null, "a")).toBeNull();
  });
});

describe("other scales", () => {
  it("have round values, and end at their last step", () => {
    const fine = { low: 0.1, high: 1, step: 0.1 };
    expect(value_after(fine, 0.2, "ArrowRight")).toBe(0.3);
    expect(value_at({ low: 1, high: 10, step: 4 }, 1)).toBe(9);
    expect(value_after({ low: 1, high: 10, step: 4 }, 5, "End")).toBe(9);
  });

  it("with many steps have five marks", () => {
    expect(marks_of({ low: 0, high: 50, step: 0.5 })).toEqual([0, 0.25, 0.5, 0.75, 1]);
  });
});
