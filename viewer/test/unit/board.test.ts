import { Group, Raycaster, Vector3 } from "three";
import { afterEach, beforeEach, expect, it, vi } from "vitest";

import { Board } from "../../src/xr/board";
import { board_text } from "../../src/xr/board_text";
import { frame, scene } from "./examples";

beforeEach(() => vi.stubGlobal("document", { createElement: () => ({}) }));
afterEach(() => vi.unstubAllGlobals());

function made() {
  let pressed = 0;
  const board = new Board(() => (pressed += 1));
  const rig = new Group();
  rig.rotation.x = Math.PI / 2; // y up into z up
  rig.add(board.mesh);
  board.mesh.visible = true;
  board.face_wearer();
  board.mesh.updateMatrixWorld(true);
  const at = (x: number, y: number, z: number): Vector3 => board.mesh.localToWorld(new Vector3(x, y, z));
  return { board, at, pressed: () => pressed };
}

it("a finger presses STOP once, and again only after it has been away", () => {
  const { board, at, pressed } = made();
  const touch = (z: number, y = -0.1): void => board.touch([at(0, y, z)]);
  touch(0.1);
  touch(0.02);
  expect(pressed()).toBe(0);
  touch(0.005);
  touch(-0.005);
  touch(0.02); // trembles
  touch(0.005);
  expect(pressed()).toBe(1);
  touch(0.1);
  touch(0.005);
  expect(pressed()).toBe(2);
  touch(0.1);
  touch(0.005, 0.1); // the words above the button
  board.touch([]);
  expect(pressed()).toBe(2);
});

it("the board stands upright beside the wearer and faces them", () => {
  const { at } = made();
  const [low, high] = [at(0, -0.2, 0), at(0, 0.2, 0)];
  expect(high.z - low.z).toBeGreaterThan(0.35);
  expect(at(0.2, 0, 0).z - at(-0.2, 0, 0).z).toBeCloseTo(0, 9);
  const head = new Vector3(0, 0, 1.55);
  expect(at(0, 0, 0.1).distanceTo(head)).toBeLessThan(at(0, 0, 0).distanceTo(head) - 0.09);
});

it("a ray presses STOP with its trigger; the rest of the board only takes it", () => {
  const { board, at, pressed } = made();
  const ray = new Raycaster();
  const from = at(0.1, 0.2, 0.6);
  const towards = (x: number, y: number): void =>
    ray.set(from, at(x, y, 0).sub(from).normalize());
  towards(0, -0.1);
  expect(board.meets(ray, false)).toBe(true);
  expect(pressed()).toBe(0);
  expect(board.meets(ray, true)).toBe(true);
  expect(pressed()).toBe(1);
  towards(0, 0.1);
  expect(board.meets(ray, true)).toBe(true);
  towards(0.5, 0);
  expect(board.meets(ray, true)).toBe(false);
  expect(pressed()).toBe(1);
  board.mesh.visible = false;
  towards(0, -0.1);
  expect(board.meets(ray, true)).toBe(false);
});

it("the board names the limit that binds most, or the next one, and when STOP may not work", () => {
  const stoppable = { ...scene, commands: ["emergency_stop"] } as never;
  const free = board_text(stoppable, { ...frame, active: [], felt: null }, "open", 1);
  expect(free.stop).toBe("STOP");
  const lost = board_text(stoppable, frame, "lost", 1);
  expect(lost).toMatchObject({ mode: "no connection", stop_note: "cannot reach the device" });
  expect(board_text(scene, frame, "open", 1).stop).toBe(scene.commands.includes("emergency_stop") ? "STOP" : "");
  const acting = { index: 0, state: "upper", cause: "position", reaction: 3 };
  const other = { ...acting, index: 1 };
  const held = { ...frame, active: [acting, other], felt: { index: 1, text: "" } } as never;
  expect(board_text(stoppable, held, "open", 1).limit).toBe(`limit ${scene.limits[1]!.name}`);
});
