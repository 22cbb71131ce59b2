import { describe, expect, it } from "vitest";

import type { Setting } from "../../src/messages";
import { headings } from "../../src/panels/change";

const setting = (group: string, name: string): Setting => ({
  group,
  name,
  label: name,
  unit: "",
  min: 0,
  max: 1,
  value: 0,
  step: 0.1,
  help: "",
});

describe("headings", () => {
  it("begin with the whole twin and end with reference wrench and felt scale", () => {
    const form = [
      setting("", "felt_scale.force.x"),
      setting("", "reference_wrench.force_N.x"),
      setting("hinge", "hinge.damping"),
      setting("lever", "lever.damping"),
      setting("", "mass_scale"),
    ];
    expect(headings(form)).toEqual([
      "Whole twin",
      "hinge",
      "lever",
      "Wrench at which it rests",
      "How strongly the hand acts on it",
    ]);
    expect(headings(form.slice(2, 4))).toEqual(["hinge", "lever"]);
  });
});
