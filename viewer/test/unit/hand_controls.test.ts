import { expect, it, vi } from "vitest";

import { grip_text, label_side } from "../../src/hand/hand_controls";
import { scene } from "./examples";

it("the label of the handle is on the side where it fits, at best to the right", () => {
  expect(label_side(300, 90, 970)).toBe("right");
  expect(label_side(800, 90, 970)).toBe("right");
  expect(label_side(900, 90, 970)).toBe("left");
  expect(label_side(213, 256, 390)).toBe("left"); // a phone
});

it("a participant reads the words beside the handle in their language", () => {
  const open_scene = { ...scene, environment: "room", twin: { ...scene.twin, joints: [] } } as never;
  vi.stubGlobal("location", { hash: "#show=hand&language=de" });
  expect(grip_text(open_scene)).toBe("Hier ziehen");
  vi.stubGlobal("location", { hash: "" });
  expect(grip_text(open_scene)).toBe("Drag me");
  vi.unstubAllGlobals();
});
