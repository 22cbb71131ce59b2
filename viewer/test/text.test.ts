import { describe, expect, it } from "vitest";

import type { Frame } from "../src/messages";
import {
  felt_text,
  hint_text,
  is_complete,
  joint_text,
  share_of_range,
  time_text,
} from "../src/text";

const frame: Frame = {
  type: "frame",
  time_s: 1,
  mode: "running",
  fault: "",
  status: "",
  q_device: [0],
  q_twin: [0],
  p_B_H_m: [0, 0, 0],
  force_N: [0, 3, 4],
  torque_Nm: [0, 0, 0],
  felt: null,
  sync_error_mm: 0,
  sync_error_deg: 0,
  cycle_time_us: 0,
  hand: { type: "hand", active: false, p_B_m: [0, 0, 0], press: 0 },
};

describe("time_text", () => {
  it("shows minutes, seconds and tenths", () => {
    expect(time_text(4.24)).toBe("0:04.2");
    expect(time_text(75)).toBe("1:15.0");
  });
});

describe("joint_text", () => {
  it("shows degrees for angles, centimetres for distances, a dash for nothing", () => {
    expect(joint_text(Math.PI / 2, { type: "revolute" })).toBe("90.0\u00b0");
    expect(joint_text(0.123, { type: "prismatic" })).toBe("12.3 cm");
    expect(joint_text(NaN, { type: "revolute" })).toBe("-");
  });
});

describe("share_of_range", () => {
  const limit = { name: "hinge", kind: "twin", unit: "rad", min: 0, max: 2 } as const;
  it("is the share of the way, clamped", () => {
    expect(share_of_range(0.5, limit)).toBe(0.25);
    expect(share_of_range(3, limit)).toBe(1);
    expect(share_of_range(-1, limit)).toBe(0);
  });
  it("is null without two ends", () => {
    expect(share_of_range(0, undefined)).toBeNull();
    expect(share_of_range(0, { ...limit, max: null })).toBeNull();
  });
});

describe("felt_text", () => {
  it("names the limit, else what else resists, else nothing", () => {
    expect(felt_text({ ...frame, felt: { index: 0, name: "m4", text: "m4: upper limit" } })).toBe(
      "m4: upper limit",
    );
    expect(felt_text(frame)).toContain("twin's mass");
    expect(felt_text({ ...frame, force_N: [0, 0, 0.2] })).toBe("nothing holds you");
  });
});

describe("is_complete", () => {
  it("is false while a coordinate is missing", () => {
    expect(is_complete(frame)).toBe(true);
    expect(is_complete({ ...frame, q_twin: [null as unknown as number] })).toBe(false);
    expect(is_complete({ ...frame, p_B_H_m: [0, NaN, 0] })).toBe(false);
  });
});

describe("hint_text", () => {
  it("mentions the lever only when there is one", () => {
    expect(hint_text(true, false)).toContain("Space presses the lever");
    expect(hint_text(false, false)).not.toContain("lever");
    expect(hint_text(true, true)).not.toContain("Shift");
  });
});
