import { describe, expect, it } from "vitest";

import { UndoList, changed, changes_yaml } from "../../src/panels/changed_values";
import type { Setting } from "../../src/messages";

const setting = (group: string, key: string, value: number | null): Setting => ({
  name: group === "" ? key : `${group}.${key}`,
  group,
  label: key,
  unit: "",
  min: -100,
  max: 100,
  value,
  step: 0.1,
  help: "",
});

const FORM = [
  setting("hinge", "damping_Nms_per_rad", 2),
  setting("hinge", "q_max_rad", null),
  setting("lever", "preload_Nm", 0.6),
  ...["x", "y", "z"].map((axis) => setting("", `reference_wrench.force_N.${axis}`, 0)),
  setting("", "gravity", 0),
  setting("", "mass_scale", 1),
];
const START = FORM.map(({ value }) => value);

describe("changed values", () => {
  it("are those that differ from the files", () => {
    expect(changed(FORM, START)).toEqual([]);
    const values = [3, 1.5, 0.6, 0, 0, 0, 0, 1];
    expect(changed(FORM, values).map(({ setting: { name } }) => name)).toEqual([
      "hinge.damping_Nms_per_rad",
      "hinge.q_max_rad",
    ]);
  });

  it("become entries of a scenario's changes", () => {
    const yaml = changes_yaml("door", FORM, [3, 1.5, 0.6, 0, -2.5, 0, 1, 0.5]);
    expect(yaml.split("\n").filter((line) => !line.startsWith("#"))).toEqual([
      "changes:",
      '  - {at_s: 0, joint: "hinge", damping_Nms_per_rad: 3, q_max_rad: 1.5}',
      "  - {at_s: 0, gravity: true, mass_scale: 0.5}",
      "  - {at_s: 0, reference_wrench: {force_N: [0, -2.5, 0]}}",
      "",
    ]);
  });
});

describe("UndoList", () => {
  it("takes back the newest first; a slider that is drawn is one step", () => {
    const steps = new UndoList();
    steps.note("a", 1, 0);
    steps.note("a", 2, 100); // still drawn
    steps.note("b", 5, 200);
    steps.note("a", 3, 5000);
    expect([steps.take(), steps.take(), steps.take(), steps.take()].map((step) => step?.from)).toEqual([
      3,
      5,
      1,
      undefined,
    ]);
  });

  it("forgets what was refused", () => {
    const steps = new UndoList();
    steps.note("a", 1, 0);
    steps.refuse("a");
    expect(steps.is_empty).toBe(true);
  });

  it("keeps a step of which one value was taken and another one refused", () => {
    const steps = new UndoList();
    steps.note("a", 1, 0);
    steps.note("a", 2, 500); // of the same step
    steps.refuse("a");
    expect(steps.take()?.from).toBe(1);
  });

  it("keeps all steps when one of them cannot be taken back", () => {
    const steps = new UndoList();
    steps.note("a", 1, 0);
    steps.note("a", 2, 5000);
    expect(steps.take()?.from).toBe(2);
    steps.refuse("a");
    expect([steps.take(), steps.take()].map((step) => step?.from)).toEqual([2, 1]);
  });

  it("takes a refusal after a new value for that of the new value", () => {
    const steps = new UndoList();
    steps.note("a", 1, 0);
    steps.take();
    steps.note("a", 1, 5000);
    steps.refuse("a");
    expect(steps.is_empty).toBe(true);
  });
});
