import { describe, expect, it } from "vitest";

import { causes, names_limits, shares, summary, total } from "../../src/panels/budget";
import { budget, wrench } from "./examples";

const pushed = budget({
  user: wrench([0, 10, 0]),
  inertia: wrench([3, 6, 0]),
  damping: wrench([-3, 5, 0]),
  spring: wrench([0, -1, 0]),
});

describe("shares", () => {
  it("add up to the user's force", () => {
    const parts = shares(pushed, "force");
    expect(parts.reduce((sum, { value }) => sum + value, 0)).toBeCloseTo(
      total(pushed, "force"),
      12,
    );
    expect(parts.find(({ part }) => part === "inertia")!.value).toBe(6);
    expect(parts.find(({ part }) => part === "spring")!.value).toBe(-1);
  });

  it("are zero while the user hardly pushes", () => {
    const light = budget({ user: wrench([0.1, 0, 0]), inertia: wrench([50, 0, 0]) });
    expect(shares(light, "force").every(({ value }) => value === 0)).toBe(true);
    expect(shares(pushed, "torque").every(({ value }) => value === 0)).toBe(true);
  });
});

const turned = (Nm: number) => ({
  force_N: wrench().force_N,
  torque_Nm: [0, 0, Nm] as [number, number, number],
});

describe("causes", () => {
  it("add up to what the hand feels, the largest first", () => {
    const found = causes(budget({ ...pushed, spring: wrench() }));
    expect(found.map(({ part }) => part)).toEqual(["inertia", "damping"]);
    expect(found.reduce((sum, { force_N }) => sum + force_N, 0)).toBeCloseTo(11, 12);
  });

  it("puts bearings of 54.7 N before the limit of a lever of 4.3 Nm", () => {
    const user = wrench([0, 64, 0]);
    const [first, second] = causes(
      budget({ user, structure: wrench([0, 54.7, 0]), limits: wrench([0, 9.3, 0]) }),
    );
    expect(first).toEqual({ part: "structure", force_N: expect.closeTo(54.7, 9) });
    expect(second!.part).toBe("limits");
  });

  it("compares a torque by the force with which it presses on the hand", () => {
    const user = { force_N: [0, 20, 0] as [number, number, number], torque_Nm: turned(3).torque_Nm };
    const parts = { structure: wrench([0, 20, 0]), limits: turned(3) };
    expect(causes(budget({ user, ...parts }))[0]!.part).toBe("limits"); // 3 Nm are 30 N
    const weak = { force_N: user.force_N, torque_Nm: turned(1).torque_Nm };
    expect(causes(budget({ user: weak, ...parts, limits: turned(1) }))[0]!.part).toBe("structure");
  });

  it("counts limits in conflict as limits", () => {
    const user = wrench([0, 10, 0]);
    const both = budget({ user, limits: wrench([0, 3, 0]), conflict: wrench([0, 3, 0]), damping: wrench([0, 4, 0]) });
    expect(causes(both)[0]).toEqual({ part: "limits", force_N: expect.closeTo(6, 9) });
  });

  it("are none while the user hardly pushes or turns", () => {
    expect(causes(budget({ user: wrench([0.1, 0, 0]), inertia: wrench([50, 0, 0]) }))).toEqual([]);
    expect(causes(budget({ user: turned(3), limits: turned(3) }))[0]!.part).toBe("limits");
  });
});

describe("summary", () => {
  it("names the largest parts that resist", () => {
    expect(summary(causes(pushed))).toBe("mostly mass of the twin (55 %) and damping (45 %)");
    expect(summary(causes(budget()))).toBe("");
  });

  it("says what it means when the bearings carry most", () => {
    const across = budget({ user: wrench([0, 10, 0]), structure: wrench([0, 10, 0]) });
    expect(summary(causes(across))).toMatch(/^mostly bearings.* you push where it cannot/);
    expect(summary(causes(pushed))).not.toContain("cannot move");
  });

  it("names the limit behind what is larger", () => {
    const found = causes(
      budget({ user: wrench([0, 10, 0]), structure: wrench([0, 7, 0]), limits: wrench([0, 3, 0]) }),
    );
    expect(names_limits(found)).toBe(true);
    expect(summary(found, "lever: upper limit, 4.3 Nm")).toBe(
      "mostly bearings of the twin (70 %), you push where it cannot move; then lever: upper limit, 4.3 Nm (30 %)",
    );
  });
});
