import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { Freshness } from "../../src/data/freshness";
import { Holder } from "../../src/data/holder";
import type { Command, Hold } from "../../src/messages";
import { stop_text } from "../../src/stop_button";
import { mode_text } from "../../src/text";
import { frame } from "./examples";

describe("Holder", () => {
  let sent: Hold[];
  let holder: Holder;
  const command = (name: string, value: number): Command => ({
    type: "command",
    id: 1,
    command: "panel",
    name,
    value,
  });

  beforeEach(() => {
    vi.useFakeTimers();
    sent = [];
    holder = new Holder((hold) => sent.push(hold) > 0);
  });
  afterEach(() => void vi.useRealTimers());

  it("is silent until a switch is taken", () => {
    holder.note(command("operator_enable", 0));
    holder.note({ ...command("", 1), command: "pause" });
    vi.advanceTimersByTime(1000);
    expect(sent).toEqual([]);
  });

  it("counts on every 30 ms, also when another switch is taken", () => {
    holder.note(command("override_key", 1));
    holder.note(command("operator_enable", 1));
    vi.advanceTimersByTime(300);
    expect(sent.map(({ sequence }) => sequence)).toEqual(sent.map((_, i) => i + 1));
    expect(sent.length).toBe(12);
  });

  it("ends, and begins again when a switch is taken again", () => {
    holder.note(command("override_key", 1));
    holder.end();
    vi.advanceTimersByTime(1000);
    expect(sent.length).toBe(1);
    holder.note(command("override_key", 1));
    vi.advanceTimersByTime(60);
    expect(sent.at(-1)!.sequence).toBe(4);
  });
});

describe("Freshness", () => {
  it("distinguishes a silent program from an idle one", () => {
    const freshness = new Freshness();
    for (let i = 0; i < 4; i++) freshness.tick();
    expect(freshness.link(true, true)).toBe("open");
    freshness.tick();
    expect(freshness.link(true, true)).toBe("silent");
    expect(freshness.link(true, false)).toBe("open"); // paused
    expect(freshness.link(false, false)).toBe("lost");
    freshness.note();
    expect(freshness.link(true, true)).toBe("open");
  });
});

describe("mode_text", () => {
  const alone = { ...frame, mode: "running" as const };
  alone.safety = { ...frame.safety, is_autonomous: true };

  it("says when it runs alone", () => {
    expect(mode_text(frame, "open").text).toBe("running");
    expect(mode_text(alone, "open")).toEqual({ text: "running alone", kind: "alone" });
    expect(mode_text({ ...alone, mode: "stopping" }, "open").text).toBe("stopping");
  });

  it("shows no outdated state", () => {
    expect(mode_text(alone, "lost")).toEqual({ text: "no connection", kind: "unknown" });
    expect(mode_text(alone, "silent")).toEqual({ text: "no data", kind: "unknown" });
    expect(mode_text(null, "open").text).toBe("-");
  });
});

describe("stop_text", () => {
  const pressed = { ...frame.safety, emergency_stop: true, stop_pressed_by: [0, 4, 7] };

  it("says who presses it", () => {
    const shown = stop_text("open", pressed, 4);
    expect(shown.text).toBe("STOPPED");
    expect(shown.note).toBe("by the script, this page, page 7");
    expect(shown.announcement).toContain("Emergency stop pressed");
  });

  it("shows a lost connection whatever was shown before", () => {
    for (const safety of [null, frame.safety, pressed]) {
      expect(stop_text("lost", safety, 4).note).toBe("cannot reach the device");
    }
    expect(stop_text("silent", frame.safety, 4).note).toBe("may not reach the device");
    expect(stop_text("open", frame.safety, 4)).toEqual({ text: "STOP", note: "Esc", announcement: "" });
  });
});
