import { BoxGeometry, Mesh, PerspectiveCamera, Quaternion, Vector3 } from "three";
import { describe, expect, it } from "vitest";

import { Cameras } from "../../src/scene/cameras";
import { FirstView, type Sights, fitted } from "../../src/scene/first_view";
import { Person } from "../../src/scene/person";
import { is_between } from "../../src/scene/see_through";
import { Voxels, points_on } from "../../src/scene/voxels";

const FLOOR = -1.2;

function box(size: [number, number, number], at: [number, number, number]): Vector3[] {
  const mesh = new Mesh(new BoxGeometry(...size));
  mesh.position.set(...at);
  return points_on(mesh);
}

// A handle in the origin with the user at `to_user`, an arm behind it, and `more`.
function sights(to_user: [number, number, number], more: Partial<Sights> = {}): Sights {
  const axis = new Vector3(...to_user);
  const person = new Person(FLOOR, axis.clone().multiplyScalar(-5));
  person.pose(new Vector3(), new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), axis));
  const [x, y] = [-0.5 * axis.x, -0.5 * axis.y];
  return {
    arm: box([0.1, 0.1, 0.9], [x, y, 0.2]),
    frame: [],
    twin: box([0.3, 0.3, 0.2], [x / 2, y / 2, -0.2]),
    person: person.parts.flatMap((part) => points_on(part)),
    around: [],
    handle: new Vector3(),
    to_user: axis,
    arrow: 0.4,
    room: [],
    ...more,
  };
}

function camera_of(aspect: number): PerspectiveCamera {
  const camera = new PerspectiveCamera(40, aspect, 0.05);
  camera.up.set(0, 0, 1);
  return camera;
}

function placed(scene: Sights, aspect: number): PerspectiveCamera {
  const camera = camera_of(aspect);
  const { from, at } = new FirstView(scene).sight(camera);
  camera.position.copy(from);
  camera.lookAt(at);
  camera.updateMatrixWorld();
  return camera;
}

function edge(points: Vector3[], camera: PerspectiveCamera): number {
  return points.reduce((most, point) => {
    const { x, y } = point.clone().project(camera);
    return Math.max(most, Math.abs(x), Math.abs(y));
  }, 0);
}

const USERS: [number, number, number][] = [
  [0, -1, 0],
  [1, 0, 0],
  [-0.6, 0.8, 0],
];

describe("the first view", () => {
  it.each([2, 1.2, 0.5])("has arm, twin, person and force in the picture, %f times as wide", (aspect) => {
    for (const user of USERS) {
      const scene = sights(user);
      const { arm, twin, person, arrow } = scene;
      const force = [new Vector3(0, 0, arrow), new Vector3(0, -arrow, 0), new Vector3(arrow, 0, 0)];
      const most = edge([...arm, ...twin, ...person, ...force], placed(scene, aspect));
      expect(most).toBeLessThan(1);
      expect(most).toBeGreaterThan(0.6); // and fills it
    }
  });

  it("has the person beside the arm, not before it", () => {
    for (const user of USERS) {
      const scene = sights(user);
      const camera = placed(scene, 1.5);
      const middle = (points: Vector3[]): number =>
        points.reduce((sum, point) => sum + point.clone().project(camera).x, 0) / points.length;
      expect(Math.abs(middle(scene.person) - middle(scene.arm))).toBeGreaterThan(0.3);
    }
  });

  it("is from where a wall does not hide the handle", () => {
    for (const side of [-1, 1]) {
      const around = box([0.05, 4, 4], [0.3 * side, 0, 0]); // beside the hand
      const scene = sights([0, -1, 0], { around });
      const { position } = placed(scene, 1.5);
      expect(position.x * side).toBeLessThan(0);
    }
  });

  it("is from where a beam does not hide the arm", () => {
    const free = placed(sights([0, -1, 0]), 1.5).position;
    const { x, y, z } = new Vector3(0, 0.5, 0.2).lerp(free, 0.25);
    const beam = box([0.6, 0.6, 0.6], [x, y, z]);
    const scene = sights([0, -1, 0], { frame: beam });
    const { position } = placed(scene, 1.5);
    const voxels = new Voxels([scene.frame]);
    const hidden = scene.arm.filter((point) => voxels.met(point, position, [0]) !== 0).length;
    const before = scene.arm.filter((point) => voxels.met(point, free, [0]) !== 0).length;
    expect(before).toBeGreaterThan(0.5 * scene.arm.length);
    expect(hidden).toBeLessThan(0.1 * scene.arm.length);
  });

  it("is the same for the same scene", () => {
    const [first, second] = [placed(sights([1, 0, 0]), 1.5), placed(sights([1, 0, 0]), 1.5)];
    expect(first.position.toArray()).toEqual(second.position.toArray());
  });

  it("looks down far enough for a level drag", () => {
    for (const user of USERS) {
      const camera = placed(sights(user), 1.5);
      const down = -camera.getWorldDirection(new Vector3()).z;
      expect(down).toBeGreaterThan(Math.sin((12 * Math.PI) / 180));
    }
  });

  it("has room for where the handle may go", () => {
    const room = [new Vector3(3, 0, 0), new Vector3(-2, 1, 0.5)];
    expect(edge(room, placed(sights([0, -1, 0], { room }), 1.5))).toBeLessThan(1);
  });

  it("fits a picture of another size, until one moves the camera", () => {
    const scene = sights([0, -1, 0]);
    const all = [...scene.arm, ...scene.twin, ...scene.person];
    const camera = camera_of(0.9);
    const cameras = new Cameras(camera, null as unknown as HTMLCanvasElement);
    const view = new FirstView(scene);
    const resize = (aspect: number): number => {
      camera.aspect = aspect;
      cameras.resize();
      cameras.controls.update();
      camera.updateMatrixWorld();
      return edge(all, camera);
    };
    cameras.begin_with(() => view.sight(camera));
    const towards = (): Vector3 => camera.position.clone().sub(cameras.controls.target).normalize();
    resize(0.9);
    const first = towards();
    for (const aspect of [1.15, 2, 0.5]) {
      expect(resize(aspect)).toBeLessThan(1);
      expect(towards().distanceTo(first)).toBeLessThan(1e-6); // it does not turn
    }
    cameras.controls.dispatchEvent({ type: "start" });
    const seen_from = camera.position.clone();
    resize(2);
    expect(camera.position.distanceTo(seen_from)).toBeLessThan(1e-9);
  });
});

describe("a fitted picture", () => {
  it("is filled from one edge to the other in one direction", () => {
    const points = box([1, 2, 0.5], [3, -1, 2]);
    const camera = camera_of(1.5);
    const towards = new Vector3(0.5, -0.8, 0.33).normalize();
    const { from, at } = fitted(points, towards, camera);
    camera.position.copy(from);
    camera.lookAt(at);
    camera.updateMatrixWorld();
    const seen = points.map((point) => point.clone().project(camera));
    const [xs, ys] = [seen.map(({ x }) => x), seen.map(({ y }) => y)];
    const widths = [Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys)];
    const full = [2 * 0.9, 0.84 + 0.8];
    expect(Math.max(widths[0]! / full[0]!, widths[1]! / full[1]!)).toBeCloseTo(1, 2);
  });
});

describe("what stands between the eye and a point", () => {
  const wall = new Mesh(new BoxGeometry(2, 0.1, 2));
  wall.position.set(0, -1, 0);
  wall.updateMatrixWorld();

  it("is known of cells and of boxes alike", () => {
    const voxels = new Voxels([points_on(wall), [new Vector3(0, 5, 5), new Vector3(0, -5, -5)]]);
    const point = new Vector3(0, 0.5, 0);
    for (const [eye, hides] of [
      [new Vector3(0, -4, 0), true],
      [new Vector3(0, 4, 0), false],
      [new Vector3(4, -0.5, 0), false],
      [new Vector3(0.5, -3, 0.5), true],
    ] as const) {
      expect(voxels.met(point, eye, [0.05, Infinity]) === 1).toBe(hides);
      expect(is_between(wall, eye, point)).toBe(hides);
    }
  });

  it("is not what lies behind the point", () => {
    expect(is_between(wall, new Vector3(0, -4, 0), new Vector3(0, -2, 0))).toBe(false);
  });
});
