import { describe, expect, it } from "vitest";

import {
  device_text,
  effort_text,
  felt_text,
  heading_text,
  is_pushing,
  joint_text,
  note_text,
  share_between,
  surfaces_text,
  time_text,
  twin_text,
  unit_text,
} from "../../src/text";
import type { SceneSurface } from "../../src/messages";
import { budget, frame, scene, wrench } from "./examples";

describe("names of device and twin", () => {
  const chosen = (twin: string, name: string, title: string) => ({
    ...scene,
    title,
    device: { ...scene.device, name: "Franka FR3" },
    twin: { ...scene.twin, name },
    choices: { ...scene.choices, twin },
  });

  it("are in the heading, the device once", () => {
    expect(heading_text(chosen("fr3/drawer", "drawer", "drawer"))).toBe("Drawer, Franka FR3");
    const title = "Cupboard, Franka FR3";
    expect(heading_text(chosen("", "cupboard", title))).toBe(title);
  });

  it("are in the choice of the twin", () => {
    expect(twin_text(chosen("", "cupboard", ""))).toBe("as in the scenario (cupboard)");
    expect(twin_text(chosen("my/gate_twin.yaml", "gate", "gate"))).toBe("Gate");
  });

  it("are in the choice of the device", () => {
    const own = chosen("", "drawer", "");
    expect(device_text(own)).toBe("as in the scenario (Franka FR3)");
    expect(device_text({ ...own, choices: { ...own.choices, device: "fr3" } })).toBe("Franka FR3");
  });
});

describe("surfaces_text", () => {
  it("counts those of the scenario, and leaves a choice as it is listed", () => {
    expect(surfaces_text(scene)).toBe("as in the scenario (none)");
    const table: SceneSurface = {
      name: "table",
      shape: "plane",
      p_B_m: [0, 0, 0],
      quaternion_B: [0, 0, 0, 1],
      size_m: [0, 0, 0],
      triangles_m: [],
    };
    expect(surfaces_text({ ...scene, surfaces: [table] })).toBe("as in the scenario (1)");
    expect(surfaces_text({ ...scene, choices: { ...scene.choices, surfaces: "none" } })).toBe("");
  });
});

describe("time_text", () => {
  it("shows minutes, seconds and tenths", () => {
    expect(time_text(4.24)).toBe("0:04.2");
    expect(time_text(75)).toBe("1:15.0");
  });

  it("never shows sixty seconds", () => {
    expect(time_text(59.97)).toBe("1:00.0");
  });
});

describe("joint_text", () => {
  it("shows degrees, centimetres, and a dash for nothing", () => {
    expect(joint_text(Math.PI / 2, { type: "revolute" })).toBe("90.0\u00b0");
    expect(joint_text(0.123, { type: "prismatic" })).toBe("12.3 cm");
    expect(joint_text(NaN, { type: "revolute" })).toBe("-");
  });
});

describe("share_between", () => {
  it("is the share of the way, clamped", () => {
    expect(share_between(0.5, 0, 2)).toBe(0.25);
    expect(share_between(3, 0, 2)).toBe(1);
    expect(share_between(-1, 0, 2)).toBe(0);
  });

  it("is null without two ends", () => {
    expect(share_between(0, null, 2)).toBeNull();
    expect(share_between(0, 0, null)).toBeNull();
    expect(share_between(NaN, 0, 2)).toBeNull();
  });
});

describe("effort_text", () => {
  const joint = { type: "revolute", tau_max: 176 } as const;

  it("has the joint's unit and its largest", () => {
    expect(effort_text(12, joint)).toBe("12.0 Nm of 176 Nm");
    expect(effort_text(-3, { type: "prismatic", tau_max: null })).toBe("-3.0 N");
  });

  it("does without a measurement", () => {
    expect(effort_text(NaN, joint)).toBe("not measured");
  });
});

describe("unit_text", () => {
  it("raises powers", () => {
    expect(unit_text("Nms^2/rad^2")).toBe("Nms\u00b2/rad\u00b2");
  });
});

describe("felt_text", () => {
  const zero: [number, number, number] = [0, 0, 0];

  const lock = {
    index: 2,
    state: "lower",
    cause: "lock",
    reaction: 3,
    excess: 0,
    text: "hinge: locked",
  } as const;
  const felt = { index: 0, name: "m4", text: "m4: upper limit", force_N: zero, torque_Nm: zero };
  const user = wrench([0, 10, 0]);

  it("names the limit, else the largest parts, else nothing", () => {
    const limited = { ...frame, felt, budget: budget({ user, limits: user }) };
    expect(felt_text(scene, limited)).toBe("m4: upper limit");
    const damped = { ...frame, felt: null, budget: budget({ user, damping: user }) };
    expect(felt_text(scene, damped)).toContain("mostly damping");
    expect(felt_text(scene, frame)).toContain("Nothing");
  });

  it("names what is larger before the limit, and the limit only where it is felt", () => {
    const parts = { structure: wrench([0, 7, 0]), limits: wrench([0, 3, 0]) };
    const both = { ...frame, felt, budget: budget({ user, ...parts }) };
    expect(felt_text(scene, both)).toMatch(/^Mostly bearings.*; then m4: upper limit \(30 %\)\.$/);
    const little = { structure: wrench([0, 9.5, 0]), limits: wrench([0, 0.5, 0]) };
    const hardly = { ...both, active: [lock], budget: budget({ user, ...little }) };
    expect(felt_text(scene, hardly)).toMatch(/^Hardly a limit: mostly bearings/);
  });

  it("does not blame a limit while the user does not push", () => {
    const free = { ...frame, force_N: zero, torque_Nm: zero, felt };
    expect(is_pushing(free)).toBe(false);
    expect(felt_text(scene, free)).toContain("do not push");
    expect(is_pushing({ ...free, torque_Nm: [0, 0, 1] })).toBe(true);
  });

  it("does not say that nothing pushes while limits hold something", () => {
    const free = { ...frame, force_N: zero, torque_Nm: zero, felt: null };
    expect(felt_text(scene, { ...free, active: [] })).toContain("nothing pushes");
    expect(felt_text(scene, { ...free, active: [lock] })).not.toContain("nothing pushes");
  });

  it("names the virtual surface that pushes", () => {
    const wall = {
      name: "wall",
      shape: "box",
      p_B_m: zero,
      quaternion_B: [0, 0, 0, 1],
      size_m: [1, 1, 1],
      triangles_m: [],
    } as const;
    const room = { ...scene, surfaces: [{ ...wall, name: "table" }, wall] } as never;
    const contact = { surface: 1, force: [0, 3, 4] as [number, number, number], proxy: zero };
    const touching = { ...frame, felt: null, contact, budget: budget({ user, surface: user }) };
    expect(felt_text(room, touching)).toBe("Virtual surface wall: 5.0 N.");
    const dragged = { ...touching, budget: budget({ user, damping: wrench([0, 9, 0]), surface: wrench([0, 1, 0]) }) };
    expect(felt_text(room, dragged)).toContain("mostly damping");
    const free = { ...touching, force_N: zero, torque_Nm: zero };
    expect(felt_text(room, free)).toContain("do not push");
    const stopped = { ...touching, contact: { ...contact, force: zero }, budget: budget({ user, damping: user }) };
    expect(felt_text(room, { ...stopped, active: [] })).toBe("No limit: mostly damping (100 %).");
  });
});

describe("note_text", () => {
  const over = { ...frame.run_state, is_over: true };
  const stopped = { ...frame, safety: { ...frame.safety, cause: "102 A stop button is pressed." } };

  it("is empty while all is well", () => {
    expect(note_text(frame, true)).toBe("");
  });

  it("shows the cause of a fault, and why the device lags", () => {
    expect(note_text(stopped, true)).toBe("102 A stop button is pressed.");
    expect(note_text({ ...frame, is_clamped: true }, true)).toContain("lost track");
  });

  it("says how a run begins again, but a recording has its bar", () => {
    expect(note_text({ ...frame, run_state: over }, true)).toMatch(/over.*starts it again/);
    expect(note_text({ ...stopped, run_state: over }, true)).toMatch(/102.*starts it again/);
    expect(note_text({ ...frame, run_state: over }, false)).toBe("");
  });
});
