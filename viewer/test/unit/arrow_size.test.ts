import { Box3, Group, Vector3 } from "three";
import { describe, expect, it, vi } from "vitest";

import type { Vec3 } from "../../src/messages";
import { arrow_size } from "../../src/scene/arrow_size";
import { HandleView } from "../../src/scene/handle_view";

vi.hoisted(() => vi.stubGlobal("matchMedia", () => ({ matches: false }))); // of the theme

// Joints of an arm with links of these lengths, m.
function arm(lengths: number[]): Group[] {
  const joints = [new Group()];
  for (const [i, length] of lengths.entries()) {
    const joint = new Group();
    joint.position.set(0, i % 2 === 0 ? length : 0, i % 2 === 0 ? 0 : length);
    joints.at(-1)!.add(joint);
    joints.push(joint);
  }
  return joints;
}

const HAPTIC_GIANT = [0, 0, 0.53, 0.67, 0.75, 0.42, 0];
const UR5E = HAPTIC_GIANT.map((length) => 0.44 * length);

// Of the arrow along z: how long it is, and how thick.
function force_arrow(joints: Group[], force_N: number): { length: number; thickness: number } {
  const handle = new HandleView(arrow_size(joints));
  const at: Vec3 = [0.3, 0.2, 0.1];
  handle.show_wrench(at, [0, 0, force_N], [0, 0, 0]);
  const shown = handle.arrows.children.find((part) => part.visible)!;
  const size = new Box3().setFromObject(shown).getSize(new Vector3());
  return { length: size.z, thickness: size.x };
}

describe("the arrow of the force", () => {
  it("has 1 cm per newton on every device", () => {
    for (const joints of [arm(HAPTIC_GIANT), arm(UR5E), []]) {
      expect(force_arrow(joints, 20).length).toBeCloseTo(0.2, 6);
    }
  });

  it("is never longer than half the arm", () => {
    expect(force_arrow(arm(UR5E), 400).length).toBeLessThan(0.5);
    expect(force_arrow(arm([0.15, 0.15]), 400).length).toBeLessThan(0.15);
    expect(force_arrow(arm(HAPTIC_GIANT), 75).length).toBeCloseTo(0.75, 6);
  });

  it("is thinner on a smaller device, but still seen", () => {
    const full = force_arrow(arm(HAPTIC_GIANT), 30).thickness;
    const small = force_arrow(arm(UR5E), 30).thickness;
    const tiny = force_arrow(arm([0.1, 0.1]), 30).thickness;
    expect(small).toBeLessThan(0.7 * full);
    expect(tiny).toBeGreaterThan(0.25 * full);
    expect(force_arrow([], 30).thickness).toBeCloseTo(full, 3);
  });

  it("does not depend on how the device is posed", () => {
    const joints = arm(UR5E);
    const before = force_arrow(joints, 400).length;
    for (const joint of joints) joint.rotation.set(0.3, -0.2, 1);
    expect(force_arrow(joints, 400).length).toBeCloseTo(before, 6);
  });
});

it("the arc of the torque is smaller on a smaller device", () => {
  const widths = [HAPTIC_GIANT, UR5E].map((lengths) => {
    const handle = new HandleView(arrow_size(arm(lengths)));
    handle.show_wrench([0, 0, 0], [0, 0, 0], [0, 0, 8]);
    const shown = handle.arrows.children.filter((part) => part.visible);
    expect(shown).toHaveLength(1);
    return new Box3().setFromObject(shown[0]!).getSize(new Vector3()).x;
  });
  expect(widths[1]!).toBeLessThan(0.7 * widths[0]!);
});
