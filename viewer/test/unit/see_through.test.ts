import { BoxGeometry, Group, Mesh, MeshStandardMaterial, Object3D, Vector3 } from "three";
import { describe, expect, it } from "vitest";

import { SeeThrough } from "../../src/scene/see_through";

const HAND = new Vector3(0, 0, 0);
const PICTURES = 60;

function shape(y: number, x = 0): Mesh<BoxGeometry, MeshStandardMaterial> {
  const material = new MeshStandardMaterial({ transparent: true, opacity: 0.8 });
  const made = new Mesh(new BoxGeometry(1, 0.1, 1), material);
  made.position.set(x, y, 0);
  return made;
}

function as_link(...parts: Object3D[]): Group {
  return Object.assign(new Group().add(...parts), { isURDFLink: true });
}

function look(see_through: SeeThrough, root: Object3D, eye: Vector3): void {
  root.updateMatrixWorld(true);
  for (let i = 0; i < PICTURES; i++) see_through.update(eye, [HAND]);
}

describe("what stands before the hand", () => {
  const before = new Vector3(0, -4, 0);

  it("fades, and comes back when one looks from elsewhere", () => {
    const [wall, behind] = [shape(-1), shape(1)];
    const root = Object.assign(as_link(wall, behind), { isURDFRobot: true });
    const see_through = new SeeThrough();
    see_through.add_links(root);
    look(see_through, root, before);
    expect(wall.material.opacity).toBeLessThan(0.25);
    expect(behind.material.opacity).toBe(0.8);
    look(see_through, root, new Vector3(4, 0, 0));
    expect(wall.material.opacity).toBeGreaterThan(0.75);
  });

  it("fades with all of its link, but not with what stands still", () => {
    const [leaf, panel, post, step] = [shape(-1), shape(-1, 3), shape(-2), shape(-2, 3)];
    const root = Object.assign(as_link(post, step), { isURDFRobot: true });
    root.add(as_link(leaf, panel));
    const see_through = new SeeThrough();
    see_through.add_links(root);
    look(see_through, root, before);
    expect(panel.material.opacity).toBeLessThan(0.25);
    expect(post.material.opacity).toBeLessThan(0.25);
    expect(step.material.opacity).toBe(0.8);
  });

  it("does not fade when it is solid", () => {
    const wall = shape(-1);
    wall.material.transparent = false;
    const see_through = new SeeThrough();
    see_through.add_links(wall);
    look(see_through, wall, before);
    expect(wall.material.opacity).toBe(0.8);
  });
});

describe("a beam of the gantry", () => {
  it("fades when it is close to the eye, whatever it hides; the arm does not", () => {
    const [near, far, arm] = [shape(-3, 2), shape(-1, 2), shape(-3)];
    const device = new Group().add(near, far, arm);
    const see_through = new SeeThrough();
    see_through.add_frame(device, arm);
    look(see_through, device, new Vector3(0, -4, 0));
    expect(near.material.opacity).toBeLessThan(0.25);
    expect([far, arm].map(({ material }) => material.opacity)).toEqual([0.8, 0.8]);
  });
});
