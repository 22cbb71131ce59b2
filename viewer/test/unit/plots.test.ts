import { describe, expect, it } from "vitest";

import { history_of } from "../../src/data/history";
import { bins_of, quantile, spans_of } from "../../src/plots/bins";
import { index_at, time_specs } from "../../src/plots/specs";
import { joint, scene } from "./examples";

describe("time_specs", () => {
  it("uses only columns that the history has", () => {
    const floating = joint("root", { type: "floating" });
    for (const twin of [scene.twin, { ...scene.twin, joints: [floating] }]) {
      const history = history_of({ ...scene, twin });
      for (const { series } of time_specs({ ...scene, twin })) {
        for (const { column } of series) expect(history.names).toContain(column);
      }
    }
  });

  it("shows angles in degrees with their limits", () => {
    const twin = time_specs(scene).find(({ id }) => id === "twin")!;
    expect(twin.unit).toBe("\u00b0");
    expect(twin.limits.map(({ value }) => Math.round(value))).toEqual([0, 86]);
  });

  it("leaves out plots without lines", () => {
    expect(time_specs(scene).map(({ id }) => id)).not.toContain("twin-position");
  });
});

describe("index_at", () => {
  it("finds the first time that is not before", () => {
    const times = Float64Array.from([1, 2, 3]);
    expect([0, 1, 1.5, 3, 4].map((time) => index_at(times, time))).toEqual([0, 0, 1, 2, 3]);
  });
});

describe("bins_of", () => {
  it("counts every value once", () => {
    expect(bins_of([0, 1, 2.5, 9, 99, -1], 4, 10)).toEqual([3, 1, 0, 2]);
  });
});

describe("quantile", () => {
  it("is a value of the sample", () => {
    expect(quantile(Float64Array.from([3, 1, 2]), 0.5)).toBe(2);
    expect(quantile(Float64Array.from([3, 1, 2]), 1)).toBe(3);
  });
});

describe("spans_of", () => {
  it("joins what belongs together", () => {
    expect(spans_of([0, 1, 2, 3, 4, 5], [0, 1, 1, -1, 0, 2])).toEqual([
      { from: 1, to: 3, state: 1 },
      { from: 3, to: 4, state: -1 },
      { from: 5, to: 5, state: 2 },
    ]);
  });
});
