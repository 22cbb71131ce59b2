import { describe, expect, it } from "vitest";

import { history_of } from "../../src/data/history";
import { bins_of, quantile, spans_of, thinned_rows } from "../../src/plots/bins";
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

  it("shows revolute joints in degrees and prismatic ones in metres", () => {
    const slide = joint("rail", { type: "prismatic", q_max: 2 });
    const turn = joint("table", { q_max: Math.PI });
    for (const joints of [
      [slide, turn],
      [turn, slide],
    ]) {
      const device = { ...scene.device, joints };
      const specs = time_specs({ ...scene, device, gantry_joints: 2 });
      const values = (id: string): unknown => specs.find((spec) => spec.id === id)?.limits;
      expect(values("gantry")).toEqual([{ series: 0, value: 180 }]);
      expect(values("gantry-slides")).toEqual([{ series: 0, value: 2 }]);
    }
  });

  it("needs no gantry", () => {
    const ids = time_specs({ ...scene, gantry_joints: 0 }).map(({ id }) => id);
    expect(ids.filter((id) => id.startsWith("gantry"))).toEqual([]);
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

describe("thinned_rows", () => {
  it("has all rows when there are few, and the newest one always", () => {
    expect(thinned_rows(2, 6, 0, 10)).toEqual([2, 3, 4, 5]);
    expect(thinned_rows(0, 100, 0, 10).at(-1)).toBe(99);
    expect(thinned_rows(0, 100, 0, 10).length).toBeLessThanOrEqual(11);
    expect(thinned_rows(3, 3, 0, 10)).toEqual([]);
  });

  it("takes the same rows while time advances and old rows are dropped", () => {
    const seen = (forgotten: number): number[] =>
      thinned_rows(0, 100, forgotten, 10)
        .slice(0, -1)
        .map((row) => row + forgotten);
    for (let forgotten = 1; forgotten < 40; forgotten++) {
      for (const row of seen(forgotten)) expect(row % 16).toBe(0);
    }
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
