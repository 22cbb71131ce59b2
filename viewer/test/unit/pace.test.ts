import { describe, expect, it } from "vitest";

import { RateMeter } from "../../src/data/rate_meter";
import { Quality } from "../../src/scene/quality";

describe("RateMeter", () => {
  it("counts the last second only", () => {
    const meter = new RateMeter();
    for (let i = 1; i <= 120; i++) meter.tick(i / 60);
    expect(meter.per_second(2)).toBe(60);
    expect(meter.per_second(2.5)).toBe(30);
    expect(meter.per_second(10)).toBe(0);
  });
});

describe("Quality", () => {
  function after(pictures: number, interval_ms: number): Quality {
    const quality = new Quality();
    for (let i = 0; i < pictures; i++) quality.observe(i * interval_ms);
    return quality;
  }

  it("stays when drawing is fast", () => {
    const quality = after(600, 16);
    expect(quality.pixel_ratio(2)).toBe(2);
    expect(quality.has_shadows).toBe(true);
  });

  it("goes down in steps when drawing is slow, to the last step", () => {
    expect(after(10, 100).pixel_ratio(2)).toBe(1);
    expect(after(10, 100).has_shadows).toBe(true);
    expect(after(20, 100).has_shadows).toBe(false);
    expect(after(1000, 100).pixel_ratio(2)).toBeLessThan(1);
  });

  it("follows the wish of the link", () => {
    const best = new Quality("best");
    for (let i = 0; i < 100; i++) best.observe(100 * i);
    expect(best.pixel_ratio(2)).toBe(2);
    expect(new Quality("fast").has_shadows).toBe(false);
    expect(new Quality("fast").pixel_ratio(2)).toBeLessThan(1);
  });

  it("does not take a hidden tab for a slow one", () => {
    expect(after(100, 5000).pixel_ratio(2)).toBe(2);
  });
});
