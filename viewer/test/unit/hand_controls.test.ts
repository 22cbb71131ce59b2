import { expect, it } from "vitest";

import { label_side } from "../../src/hand/hand_controls";

it("the label of the handle is on the side where it fits, at best to the right", () => {
  expect(label_side(300, 90, 970)).toBe("right");
  expect(label_side(800, 90, 970)).toBe("right");
  expect(label_side(900, 90, 970)).toBe("left");
  expect(label_side(213, 256, 390)).toBe("left"); // a phone
});
