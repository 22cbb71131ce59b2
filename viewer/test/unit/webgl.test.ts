import { describe, expect, it } from "vitest";

import { no_space_text } from "../../src/picture/webgl";

describe("no_space_text", () => {
  it("has the browser's own words, as far as there are any", () => {
    expect(no_space_text("")).toBe("No 3-D picture: this browser offers no WebGL 2.");
    expect(no_space_text("WebGL is currently disabled.")).toMatch(/WebGL 2 \(WebGL is currently disabled\)\.$/);
  });

  it("of many lines keeps the code of the failure", () => {
    const firefox =
      "WebGL creation failed: \n* tryNativeGL ()\n* Exhausted GL driver options. (FEATURE_FAILURE_WEBGL_EXHAUSTED_DRIVERS)";
    expect(no_space_text(firefox)).toMatch(/WebGL 2 \(FEATURE_FAILURE_WEBGL_EXHAUSTED_DRIVERS\)\.$/);
    expect(no_space_text("Out of luck:\nno driver")).toMatch(/WebGL 2 \(Out of luck\)\.$/);
  });
});
