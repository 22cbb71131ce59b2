import { Quaternion, Vector3 } from "three";
import { describe, expect, it } from "vitest";

import { turned } from "../../src/hand/turn";
import { elbow_between } from "../../src/scene/reach";
import { grip_target, placed_at, placed_rig } from "../../src/xr/grip";

describe("turned", () => {
  it("turns about the vertical and about the view's right", () => {
    const view: [number, number, number] = [0, 1, 0];
    const right = new Quaternion(...turned([0, 0, 0, 1], 100, 0, view));
    expect(new Vector3(0, 0, 1).applyQuaternion(right).z).toBeCloseTo(1, 12);
    const down = new Quaternion(...turned([0, 0, 0, 1], 0, 100, view));
    expect(new Vector3(1, 0, 0).applyQuaternion(down).x).toBeCloseTo(1, 12);
    expect(turned([0, 0, 0, 1], 0, 0, view)).toEqual([0, 0, 0, 1]);
  });
});

describe("grip_target", () => {
  it("moves and turns the handle with the controller", () => {
    const half = new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), 0.5);
    const held = {
      from: new Vector3(5, 5, 5),
      attitude: new Quaternion(),
      handle: new Vector3(1, 0, 0),
      handle_attitude: half,
    };
    const { p_B, turn } = grip_target(held, new Vector3(5, 5.2, 5), half);
    expect(p_B).toEqual([1, expect.closeTo(0.2, 12), 0]);
    expect(2 * Math.asin(turn[2])).toBeCloseTo(1, 12);
  });
});

describe("placed_rig", () => {
  it("puts the wearer on the floor before the handle, looking at it", () => {
    const { position, quaternion } = placed_rig(
      new Vector3(1, 2, -0.8),
      new Vector3(0, -1, 0.2),
      -2,
    );
    expect(position.toArray()).toEqual([1, expect.closeTo(1.45, 12), -2]);
    const ahead = new Vector3(0, 0, -1).applyQuaternion(quaternion);
    expect(ahead.y).toBeCloseTo(1, 12);
    expect(new Vector3(0, 1, 0).applyQuaternion(quaternion).z).toBeCloseTo(1, 12);
    expect(new Vector3(1, 0, 0).applyQuaternion(quaternion).x).toBeCloseTo(1, 12);
  });
});

describe("elbow_between", () => {
  it("keeps the lengths of both parts and bends towards the point", () => {
    const [shoulder, wrist] = [new Vector3(0, 0, 1.4), new Vector3(0.3, 0.2, 1.2)];
    const elbow = elbow_between(shoulder, wrist, 0.31, 0.29, new Vector3(0, 0, 0));
    expect(elbow.distanceTo(shoulder)).toBeCloseTo(0.31, 12);
    expect(elbow.distanceTo(wrist)).toBeCloseTo(0.29, 12);
    expect(elbow.z).toBeLessThan(1.2);
  });

  it("stretches when the wrist is too far away", () => {
    const elbow = elbow_between(
      new Vector3(),
      new Vector3(2, 0, 0),
      0.3,
      0.3,
      new Vector3(0, 0, 1),
    );
    expect(elbow.toArray()).toEqual([1, 0, 0]);
  });
});

describe("placed_at", () => {
  it("puts the handle above the place on the floor, turned to the wearer, wherever the head is", () => {
    const handle = new Vector3(1, 2, -0.8);
    const to_user = new Vector3(0, -1, 0.2);
    for (const [x, z] of [[0, 0], [2, 0.5], [-1, -3]] as const) {
      const place = new Vector3(0.4, 0.02, -1.5);
      const head = new Vector3(x, 1.6, z);
      const { position, quaternion } = placed_at(place, head, handle, to_user, -2);
      const in_B = (point: Vector3): Vector3 => point.clone().applyQuaternion(quaternion).add(position);
      const below = in_B(place.clone().setY(0));
      expect(below.distanceTo(new Vector3(1, 2, -2))).toBeLessThan(1e-9);
      const towards = in_B(head).sub(below).setZ(0).normalize();
      expect(towards.dot(new Vector3(0, -1, 0))).toBeCloseTo(1, 9);
      expect(in_B(head).z).toBeCloseTo(-0.4, 9); // true height above the floor
    }
  });
});
