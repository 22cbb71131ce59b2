import { Box3, Group, Vector3 } from "three";
import { expect, it } from "vitest";

import type { SceneShape } from "../../src/messages";
import { add_shapes } from "../../src/scene/collision_shapes";

const capsule: SceneShape = {
  name: "hand_1",
  link: "hand",
  p_link_m: [0, 0, 1],
  quaternion_link: [Math.SQRT1_2, 0, 0, Math.SQRT1_2], // z of the shape along -y of the link
  radius_m: 0.1,
  length_m: 0.4,
  size_m: [0, 0, 0],
};
const box: SceneShape = {
  ...capsule,
  quaternion_link: [0, 0, 0, 1],
  radius_m: 0,
  length_m: 0,
  size_m: [0.2, 0.4, 0.6],
};

function size_on_link(shape: SceneShape): number[] {
  const hand = new Group();
  expect(add_shapes([shape], { link: () => hand })).toHaveLength(1);
  const bounds = new Box3().setFromObject(hand);
  expect(bounds.getCenter(new Vector3()).distanceTo(new Vector3(0, 0, 1))).toBeLessThan(1e-6);
  return bounds.getSize(new Vector3()).toArray();
}

it("a capsule has its segment along z, and a ball at each end", () => {
  for (const [axis, size] of [0.2, 0.6, 0.2].entries()) {
    expect(size_on_link(capsule)[axis]).toBeCloseTo(size, 2);
  }
});

it("a box has its size", () => {
  for (const [axis, size] of box.size_m.entries()) {
    expect(size_on_link(box)[axis]).toBeCloseTo(size, 6);
  }
});

it("shapes of links that are not drawn are left out", () => {
  expect(add_shapes([capsule], { link: () => null })).toHaveLength(0);
});
