import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { Commands, type Refusal } from "../../src/data/commands";
import type { Command } from "../../src/messages";

describe("Commands", () => {
  let sent: Command[];
  let refused: Refusal[];
  let is_connected: boolean;
  let commands: Commands;

  beforeEach(() => {
    vi.useFakeTimers();
    sent = [];
    refused = [];
    is_connected = true;
    commands = new Commands(
      (command) => is_connected && sent.push(command) > 0,
      (refusal) => refused.push(refusal),
    );
  });
  afterEach(() => void vi.useRealTimers());

  it("names the command of a refusal", () => {
    commands.send("scenario", "walk");
    commands.send("pause");
    commands.take({ type: "answer", id: sent[0]!.id, is_accepted: false, reason: "unknown" });
    commands.take({ type: "answer", id: sent[1]!.id, is_accepted: true, reason: "" });
    expect(refused).toEqual([{ command: "scenario", name: "walk", reason: "unknown" }]);
  });

  it("distinguishes a refused message from a refused command", () => {
    commands.take({ type: "answer", id: -1, is_accepted: false, reason: "too long" });
    expect(refused).toEqual([{ command: "message", name: "", reason: "too long" }]);
  });

  it("refuses while there is no connection", () => {
    is_connected = false;
    commands.send("pause");
    expect(refused).toHaveLength(1);
  });

  it("sends at most ten slider values a second, and the last one", () => {
    for (let i = 0; i < 100; i++) {
      commands.set("hinge.damping", i);
      vi.advanceTimersByTime(10);
    }
    vi.advanceTimersByTime(1000);
    expect(sent.length).toBeLessThanOrEqual(11);
    expect(sent.length).toBeGreaterThan(5);
    expect(sent[0]!.value).toBe(0);
    expect(sent.at(-1)!.value).toBe(99);
  });

  it("does not let one setting wait for another", () => {
    commands.set("a", 1);
    commands.set("b", 2);
    expect(sent.map(({ name }) => name)).toEqual(["a", "b"]);
  });
});
