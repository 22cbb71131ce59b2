import { describe, expect, it } from "vitest";

import { refusal_text } from "../../src/panels/choices";

describe("refusal_text", () => {
  it("is one sentence that names what was not changed", () => {
    const reason = "the Franka FR3 cannot hold the handle of the door where it starts (too far)";
    expect(refusal_text({ command: "device", name: "fr3", reason })).toBe(
      `Device not changed: ${reason}.`,
    );
    expect(refusal_text({ command: "surfaces", name: "none", reason: "no" })).toMatch(/^Virtual surf/);
  });

  it("names other commands as they are", () => {
    expect(refusal_text({ command: "pause", name: "", reason: "it is over" })).toBe("pause: it is over");
  });
});
