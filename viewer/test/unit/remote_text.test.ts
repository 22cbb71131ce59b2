import { describe, expect, it } from "vitest";

import { apart, history_of, row_of } from "../../src/data/history";
import type { SceneTeleoperation } from "../../src/messages";
import { time_specs } from "../../src/plots/specs";
import {
  METHODS,
  apart_text,
  clutch_state,
  clutch_text,
  force_on_hand,
  link_text,
  method_text,
  who_holds,
} from "../../src/remote_text";
import { frame, remote_now, remote_tool, scene } from "./examples";

const arm: SceneTeleoperation = {
  ...remote_tool,
  mapping: "joints",
  axes: [
    { name: "swing", min: -1, max: 1 },
    { name: "boom", min: 0, max: 0.8 },
  ],
  walls: [],
};

describe("who holds back whom", () => {
  const tool = (more: Parameters<typeof remote_now>[0]): string => who_holds(remote_tool, remote_now(more));

  it("says that nothing holds a machine that follows", () => {
    expect(tool({})).toBe("The remote machine follows your hand, 3 mm behind; nothing holds either of you.");
  });

  it("names the end of a range and the force on the hand", () => {
    const text = tool({ cause: "range", x_remote: [0, 0, -0.5], f_leader: [0, 0, 11.5] });
    expect(text).toBe("The remote machine is at the end of its range (z at -0.50 m): it holds you back with 23 N.");
    const now = remote_now({ cause: "range", x_remote: [0, 0.8], x_target: [0, 0.9], f_leader: [0, 4] });
    expect(who_holds(arm, now)).toContain("(joint 2, boom at 45.8\u00b0): it holds you back with 8.0 Nm.");
  });

  it("distinguishes a wall from a machine that lags", () => {
    expect(tool({ f_remote: [0, -8, 0], f_leader: [0, -4, 0] })).toBe(
      "The remote machine presses something with 8.0 N: it holds you back with 8.0 N.",
    );
    expect(tool({ f_leader: [0, -4, 0], x_remote: [0, 0, 0] })).toBe(
      "The remote machine lags 100 mm behind, and holds you back with 8.0 N.",
    );
  });

  it("names a silent link, and the way back", () => {
    const fading = tool({ link: "lost", cause: "silent", age_s: 0.4, round_trip_s: 0.1, f_leader: [0, 1, 0] });
    expect(fading).toMatch(/^The link is silent for 0.4 s: the force fades, the remote machine holds\. .*\(C\)/);
    expect(tool({ link: "lost", cause: "silent", age_s: 1.4 })).toContain("you feel no force");
    expect(tool({ link: "lost", cause: "silent", age_s: 0.1 })).toContain("is back");
    expect(tool({ link: "lost", cause: "jump", age_s: 0.1 })).toContain("because what it was sent jumped");
  });

  it("says who opened the clutch, and what keeps it from closing", () => {
    expect(tool({ link: "released", is_clutch_open: true })).toContain("Close it (C)");
    expect(tool({ link: "released" })).not.toContain("(C)");
    const apart_now = remote_now({ link: "released", x_target: [0, 0.3], x_remote: [0, 0.2] });
    expect(who_holds(arm, apart_now)).toContain("5.7\u00b0 apart (boom)");
  });
});

describe("the words of a teleoperation", () => {
  it("shows the force at the scale of the hand", () => {
    expect(force_on_hand(remote_tool, remote_now({ f_leader: [3, 4, 0] }))).toBe(10);
  });

  it("says that a force fades after the clutch was opened", () => {
    expect(clutch_state(remote_now())).toBe("engaged");
    expect(clutch_state(remote_now({ link: "released", f_leader: [1, 0, 0] }))).toBe("fading");
    expect(clutch_text(remote_now({ link: "released" }))).toBe("Clutch: open");
  });

  it("measures a distance only while the machine is led", () => {
    expect(apart(remote_now())).toBeCloseTo(0.003);
    expect(apart(remote_now({ link: "lost" }))).toBeNull();
    expect(apart_text(remote_tool, remote_now({ x_remote: [] }))).toBe("");
    expect(apart_text(arm, remote_now({ x_target: [0, 0.3], x_remote: [0, 0.2] }))).toBe("5.7\u00b0 (boom)");
  });

  it("says what was measured of the link", () => {
    expect(link_text(remote_now())).toEqual({ round_trip: "213 ms", jitter: "7 ms", lost: "5.0 %", age: "100 ms" });
    expect(link_text(remote_now({ age_s: 1.44, loss: 1 }))).toMatchObject({ lost: "100 %", age: "1.4 s" });
    expect(link_text(remote_now({ link: "waiting" })).round_trip).toBe("-");
  });

  it.each(Object.keys(METHODS))("explains the method %s", (method) => {
    expect(method_text({ ...remote_tool, method })).toMatch(/^[A-Z].+: .+\.$/);
  });
  it("names a method of others as it is", () => {
    expect(method_text({ ...remote_tool, method: "my_own" })).toBe("My own");
  });
});

describe("the history of a teleoperation", () => {
  it("has both energies, and columns only where there is a remote machine", () => {
    const far = { ...scene, teleoperation: remote_tool };
    const table = history_of(far);
    table.push(row_of(far, { ...frame, teleoperation: remote_now({ energy_leader: 1.5, energy_remote: -0.5 }) }));
    expect(table.last("remote.energy_leader_J")).toBe(1.5);
    expect(table.last("remote.energy_remote_J")).toBe(-0.5);
    expect(table.last("remote.apart")).toBeCloseTo(0.003);
    expect(history_of(scene).names).not.toContain("remote.energy_leader_J");
    expect(time_specs(far).map(({ id }) => id)).toContain("remote-energy");
    expect(time_specs(scene).map(({ id }) => id)).not.toContain("remote-energy");
  });
});
