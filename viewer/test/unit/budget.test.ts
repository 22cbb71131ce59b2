import { describe, expect, it } from "vitest";

import { limits_matter, shares, summary, total } from "../../src/panels/budget";
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

describe("summary", () => {
  it("names the largest parts that resist", () => {
    expect(summary(shares(pushed, "force"))).toBe(
      "mostly mass of the twin (55 %) and damping (45 %)",
    );
    expect(summary(shares(budget(), "force"))).toBe("");
  });

  it("says what it means when the bearings carry most", () => {
    const across = budget({ user: wrench([0, 10, 0]), structure: wrench([0, 10, 0]) });
    expect(summary(shares(across, "force"))).toMatch(/^mostly bearings.* you push where it cannot/);
    expect(summary(shares(pushed, "force"))).not.toContain("cannot move");
  });
});

describe("limits_matter", () => {
  it("is false while a limit carries little of the felt force", () => {
    const user = wrench([0, 20, 0]);
    const bearings = wrench([0, 20, 0]);
    const little = wrench([0, 0.1, 0]);
    expect(limits_matter(budget({ user, structure: bearings, limits: little }))).toBe(false);
    expect(limits_matter(budget({ user, limits: bearings }))).toBe(true);
    expect(limits_matter(budget({ user, conflict: bearings }))).toBe(true);
  });

  it("looks at torques, too", () => {
    const turned = { force_N: wrench().force_N, torque_Nm: [0, 0, 3] as [number, number, number] };
    expect(limits_matter(budget({ user: turned, limits: turned }))).toBe(true);
  });
});
