import { describe, expect, it } from "vitest";

import { read_message } from "../../src/data/read_message";
import { frame } from "./examples";

const read = (message: unknown): unknown => read_message(JSON.stringify(message));

describe("read_message", () => {
  it("takes what is as messages.ts says", () => {
    expect(read(frame)).toEqual(frame);
    const answer = { type: "answer", id: 4, is_accepted: false, reason: "too large" };
    expect(read(answer)).toEqual(answer);
    expect(read({ type: "values", values: [1, null] })).toEqual({
      type: "values",
      values: [1, null],
    });
  });

  it("says what is wrong with anything else", () => {
    expect(read_message("{")).toBe("not JSON");
    expect(read_message("null")).toBe("not an object");
    expect(read({ type: "toString" })).toContain("unknown type");
    expect(read({})).toContain("unknown type");
    expect(read({ ...frame, q_twin: [null] })).toContain("q_twin");
    expect(read({ ...frame, p_B_H_m: [0, 1] })).toContain("p_B_H_m");
    expect(read({ ...frame, budget: undefined })).toContain("budget");
    expect(read({ type: "event", run: 1, time_s: 0, name: 3, text: "" })).toContain("name");
  });

  it("takes numbers that may be missing", () => {
    expect(read({ ...frame, cycle_time_us: null })).toMatchObject({ type: "frame" });
    expect(read({ ...frame, limit_distance: [null, 1, null] })).toMatchObject({ type: "frame" });
  });
});
