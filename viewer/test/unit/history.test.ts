import { describe, expect, it } from "vitest";

import { Table, coordinates_of, history_of, row_of } from "../../src/data/history";
import { frame, joint, scene } from "./examples";

describe("Table", () => {
  it("keeps the newest rows in their order", () => {
    const table = new Table(["a", "b"], 5);
    for (let i = 0; i < 23; i++) {
      table.push([i, -i]);
      expect(table.length).toBe(Math.min(5, i + 1));
      expect(table.last("a")).toBe(i);
      expect(table.first_row).toBe(Math.max(0, i - 4));
    }
    expect([...table.column("a")]).toEqual([18, 19, 20, 21, 22]);
    expect([...table.column("b")]).toEqual([-18, -19, -20, -21, -22]);
  });

  it("writes CSV with empty fields for missing numbers", () => {
    const table = new Table(["a", "b"], 5);
    table.push([0.1, null]);
    expect(table.csv()).toBe("a,b\n0.1,\n");
  });

  it("lists its columns", () => {
    expect(() => new Table(["a"]).column("b")).toThrow("b");
  });
});

describe("history of a scene", () => {
  it("has a row for each frame that fits its columns", () => {
    const table = history_of(scene);
    const row = row_of(scene, {
      ...frame,
      active: [
        { index: 1, state: "upper", cause: "position", reaction: 1, excess: 0, text: "" },
        { index: 2, state: "lower", cause: "lock", reaction: 1, excess: 0, text: "" },
      ],
    });
    expect(row.length).toBe(table.names.length);
    table.push(row);
    expect(table.last("force_N")).toBe(5);
    expect(table.last("device.m2")).toBe(0.3);
    expect(table.last("twin.hinge")).toBe(0.4);
    expect(table.last("torque.m2_Nm")).toBe(6);
    expect(table.last("elbow_y_m")).toBe(5);
    expect(table.last("active.manipulator.m2")).toBe(0);
    expect(table.last("active.cartesian.hand x")).toBe(1);
    expect(table.last("active.twin.hinge")).toBe(-1);
  });

  it("keeps joints of device and twin with the same name apart", () => {
    const limits = scene.limits.map((limit) => ({ ...limit, name: "same" }));
    const { names } = history_of({ ...scene, limits });
    expect(new Set(names).size).toBe(names.length);
  });

  it("counts seven coordinates for a floating joint", () => {
    expect(coordinates_of([joint("root", { type: "floating" }), joint("a")])).toHaveLength(8);
  });
});
