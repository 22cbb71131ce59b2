import { describe, expect, it } from "vitest";

import { felt_text, joint_text, share_between, time_text } from "../../src/text";
import { frame } from "./examples";

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
  it("shows degrees for angles, centimetres for distances, a dash for nothing", () => {
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

describe("felt_text", () => {
  const zero: [number, number, number] = [0, 0, 0];

  it("names the limit, else the largest parts, else nothing", () => {
    const felt = { index: 0, name: "m4", text: "m4: upper limit", force_N: zero, torque_Nm: zero };
    expect(felt_text({ ...frame, felt }, "")).toBe("m4: upper limit");
    expect(felt_text(frame, "mostly damping (60 %)")).toContain("mostly damping");
    expect(felt_text({ ...frame, force_N: [0, 0, 0.2] }, "mostly damping")).toContain("Nothing");
  });
});
