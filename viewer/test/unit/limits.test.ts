import { describe, expect, it } from "vitest";

import {
  distance_text,
  limit_closeness,
  nearest_limits,
  reaction_text,
  reason_text,
} from "../../src/limit_words";
import type { ActiveLimit } from "../../src/messages";
import { frame, scene } from "./examples";

const acting: ActiveLimit = {
  index: 1,
  state: "upper",
  cause: "velocity",
  reaction: -12.34,
  excess: 0,
  text: "",
};

describe("limit_closeness", () => {
  it("is active, near or far", () => {
    const now = { ...frame, active: [acting], limit_distance: [0.01, 0.5, 1] };
    expect([0, 1, 2].map((i) => limit_closeness(scene, now, i))).toEqual(["near", "active", "far"]);
    const unbounded = { ...frame, limit_distance: [null, null, null] };
    expect(limit_closeness(scene, unbounded, 0)).toBe("far");
  });
});

describe("nearest_limits", () => {
  it("leaves out those that act and compares angles with distances", () => {
    const now = { ...frame, active: [acting], limit_distance: [0.3, 0.0, 0.2] };
    expect(nearest_limits(scene, now, 3).map(({ index }) => index)).toEqual([2, 0]);
    const some = { ...frame, limit_distance: [0.3, 0.05, null] };
    expect(nearest_limits(scene, some, 3).map(({ index }) => index)).toEqual([1, 0]);
  });
});

describe("words", () => {
  it("have units", () => {
    expect(reason_text(scene.limits[1]!, acting)).toBe(
      "cannot move faster \u00b7 wall of the workspace",
    );
    expect(reason_text(scene.limits[1]!, { ...acting, cause: "braking" })).toBe(
      "slower here, at this speed it could not stop before its end \u00b7 wall of the workspace",
    );
    expect(reaction_text(-12.34, "m")).toBe("12 N");
    expect(reaction_text(1.25, "rad")).toBe("1.3 Nm");
    expect(distance_text(0.05, "m")).toBe("5.0 cm");
    expect(distance_text(-0.0002, "m")).toBe("0.0 cm");
    expect(distance_text(-0.012, "m")).toBe("-1.2 cm");
    expect(distance_text(Math.PI / 4, "rad")).toBe("45.0\u00b0");
  });
});
