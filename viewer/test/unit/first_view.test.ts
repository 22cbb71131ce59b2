import { Mesh, PerspectiveCamera, Quaternion, Vector3 } from "three";
import { describe, expect, it } from "vitest";

import type { Frame, Scene } from "../../src/messages";
import { Cameras } from "../../src/scene/cameras";
import { foot_of_arm, sight_of, what_matters } from "../../src/scene/first_view";
import { Person } from "../../src/scene/person";

function arm(handle: number[], twin: number[]): { scene: Scene; frame: Frame } {
  const scene = {
    gantry_joints: 0,
    floor_z_m: -0.75,
    device: { p_B_root_m: [0, 0, 0] },
    twin: { p_B_root_m: twin },
  } as unknown as Scene;
  return { scene, frame: { p_B_H_m: handle } as unknown as Frame };
}

// Where the parts of the person who holds the handle reach to.
function outline_of_person(scene: Scene, frame: Frame, foot: Vector3): Vector3[] {
  const person = new Person(scene.floor_z_m, foot);
  person.pose(new Vector3(...frame.p_B_H_m), new Quaternion());
  person.group.updateMatrixWorld(true);
  const points: Vector3[] = [];
  person.group.traverse((part) => {
    if (!(part instanceof Mesh)) return;
    const shape = part.geometry.getAttribute("position");
    for (let i = 0; i < shape.count; i++) {
      points.push(new Vector3().fromBufferAttribute(shape, i).applyMatrix4(part.matrixWorld));
    }
  });
  return points;
}

function seen(places: Vector3[], aspect: number, shown = places): Vector3[] {
  const camera = new PerspectiveCamera(40, aspect, 0.05);
  camera.up.set(0, 0, 1);
  const { from, at } = sight_of(places, camera);
  camera.position.copy(from);
  camera.lookAt(at);
  camera.updateMatrixWorld();
  return shown.map((place) => place.clone().project(camera));
}

describe("the first view of an arm", () => {
  const arms = [
    arm([0.35, 0, 0.3], [0.4, 0.1, 0.3]),
    arm([0.5, -0.4, 0.4], [0.6, -0.6, 0.1]),
    arm([-0.9, 0.8, 0.6], [-1, 0.5, 0.2]),
  ];

  it.each([2, 1.2, 0.6])("has arm, mechanism and person in the picture, %f times as wide", (aspect) => {
    for (const { scene, frame } of arms) {
      const pixels = seen(what_matters(scene, frame, foot_of_arm(scene)!), aspect);
      const most = Math.max(...pixels.flatMap(({ x, y }) => [Math.abs(x), Math.abs(y)]));
      expect(most).toBeLessThan(1);
      expect(most).toBeGreaterThan(0.5); // and fills it
    }
  });

  it.each([1.3, 0.6])("has the person from head to foot in the picture, %f times as wide", (aspect) => {
    for (const { scene, frame } of arms) {
      const foot = foot_of_arm(scene)!;
      const person = outline_of_person(scene, frame, foot);
      const pixels = seen(what_matters(scene, frame, foot), aspect, person);
      expect(Math.max(...pixels.map(({ x, y }) => Math.max(Math.abs(x), Math.abs(y))))).toBeLessThan(1);
    }
  });

  it("is not that of a device that hangs above the person", () => {
    const { scene } = arms[0]!;
    expect(foot_of_arm({ ...scene, gantry_joints: 2 })).toBeNull();
  });

  it("is taken from where arm and person do not hide one another", () => {
    const { scene, frame } = arms[1]!;
    const [handle, foot] = seen(what_matters(scene, frame, foot_of_arm(scene)!), 1.5);
    expect(Math.abs(handle!.x - foot!.x)).toBeGreaterThan(0.2);
  });

  it("fits a picture of another size, until one moves the camera", () => {
    const { scene, frame } = arms[0]!;
    const places = what_matters(scene, frame, foot_of_arm(scene)!);
    const camera = new PerspectiveCamera(40, 0.9, 0.05);
    const cameras = new Cameras(camera, null as unknown as HTMLCanvasElement);
    const resize = (aspect: number): number => {
      camera.aspect = aspect;
      cameras.resize();
      cameras.controls.update();
      camera.updateMatrixWorld();
      const pixels = places.map((place) => place.clone().project(camera));
      return Math.max(...pixels.flatMap(({ x, y }) => [Math.abs(x), Math.abs(y)]));
    };
    cameras.begin_with(() => sight_of(places, camera));
    for (const aspect of [0.9, 1.15, 2, 0.5]) expect(resize(aspect)).toBeLessThan(1);
    cameras.controls.dispatchEvent({ type: "start" });
    const seen_from = camera.position.clone();
    resize(2);
    expect(camera.position.distanceTo(seen_from)).toBeLessThan(1e-9);
  });
});
