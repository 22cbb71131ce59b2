import { describe, expect, it } from "vitest";

import {
  type Ray,
  dot,
  drag_normal,
  meet_axis,
  meet_plane,
  norm,
  subtract,
  within_reach,
} from "../../src/hand/drag_plane";
import type { Vec3 } from "../../src/messages";

function unit(v: Vec3): Vec3 {
  return [v[0] / norm(v), v[1] / norm(v), v[2] / norm(v)];
}

const down: Ray = { origin: [0, -4, 1], direction: unit([0.1, 1, -0.4]) };

describe("drag_normal", () => {
  it("is level below a camera and faces a level one", () => {
    expect(drag_normal(unit([0, 1, -0.5]))).toEqual([0, 0, 1]);
    expect(drag_normal(unit([0, 1, 0.5]))).toEqual([0, 0, 1]);
    const level = unit([0.3, 1, -0.1]);
    expect(drag_normal(level)).toEqual(level);
  });
});

describe("meet_plane", () => {
  it("gives the point of the plane that is on the ray", () => {
    const point: Vec3 = [1, 2, -1];
    const met = meet_plane(down, point, [0, 0, 1])!;
    expect(met[2]).toBeCloseTo(-1, 12);
    const away = subtract(met, down.origin);
    expect(dot(unit(away), down.direction)).toBeCloseTo(1, 12);
  });

  it("gives nothing along the plane or behind the camera", () => {
    expect(meet_plane(down, [0, 0, 3], [0, 0, 1])).toBeNull();
    const level: Ray = { origin: [0, 0, 1], direction: [0, 1, 0] };
    expect(meet_plane(level, [0, 0, 0], [0, 0, 1])).toBeNull();
  });
});

describe("meet_axis", () => {
  const up: Vec3 = [0, 0, 1];

  it("moves only along the axis", () => {
    const point: Vec3 = [0.2, 1, -1];
    const met = meet_axis(down, point, up)!;
    expect(met.slice(0, 2)).toEqual([0.2, 1]);
    const higher = meet_axis({ ...down, direction: unit([0.1, 1, -0.3]) }, point, up)!;
    expect(higher[2]).toBeGreaterThan(met[2]);
  });

  it("gives the point of the axis that the ray meets", () => {
    const met = meet_axis({ origin: [3, -4, 1], direction: [0, 1, 0] }, [0, 0, 1], [1, 0, 0])!;
    expect(met[0]).toBeCloseTo(3, 12);
    expect(met.slice(1)).toEqual([0, 1]);
  });

  it("gives nothing when the camera looks along the axis", () => {
    expect(meet_axis({ origin: [0, 0, 5], direction: [0, 0, -1] }, [0, 0, 0], up)).toBeNull();
  });
});

describe("within_reach", () => {
  it("shortens far targets in their direction only", () => {
    expect(within_reach([1, 0, 0], [0.5, 0, 0], 1)).toEqual([1, 0, 0]);
    expect(within_reach([5, 0, 0], [1, 0, 0], 1)).toEqual([2, 0, 0]);
    expect(within_reach([1, 1, 1], [1, 1, 1], 1)).toEqual([1, 1, 1]);
  });
});
