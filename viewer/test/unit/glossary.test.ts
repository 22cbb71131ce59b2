import { readFileSync } from "node:fs";

import { describe, expect, it } from "vitest";

import { WORDS, words_in } from "../../src/guide/words";
import { kind_text, reason_text } from "../../src/limit_words";
import type { ActiveLimit, SceneLimit } from "../../src/messages";
import { PARTS } from "../../src/panels/budget";

const words_of = (text: string): string[] => words_in(text).map(({ entry }) => entry.word);

describe("the glossary", () => {
  it.each(Object.values(PARTS))("explains the part of the force: %s", (text) => {
    for (const part of text.split(", ")) expect(words_of(part)).not.toEqual([]);
  });

  const kinds: SceneLimit["kind"][] = ["manipulator", "virtual", "cartesian", "motor", "twin"];
  it.each(kinds)("explains the kind of limit: %s", (kind) => {
    expect(words_of(kind_text(kind))).not.toEqual([]);
  });

  it("explains that the device would hit itself", () => {
    expect(words_of(kind_text("self_collision"))).toContain("self-collision");
  });

  const causes: ActiveLimit["cause"][] = ["position", "lock", "latch", "friction", "contradiction", "torque"];
  it.each(causes)("explains why a limit acts: %s", (cause) => {
    const limit = { kind: "manipulator" } as SceneLimit;
    const text = reason_text(limit, { cause } as ActiveLimit).split(" \u00b7 ")[0]!;
    expect(words_of(text)).not.toEqual([]);
  });

  // what the panels write themselves
  const own = /"([A-Z][a-z][^"$]*)"/g;
  const panels = ["safety", "joints", "feel"].map((name) =>
    readFileSync(`${__dirname}/../../src/panels/${name}.ts`, "utf8"),
  );
  const technical = [
    "Emergency stop", "Enabling switch held", "Override key", "Person in the field", "Reset", "Arm",
    "Run", "Run alone", "Hold", "Twin", "Device",
  ];
  it.each(technical)("explains %s, which a panel says", (text) => {
    expect(panels.some((source) => [...source.matchAll(own)].some((found) => found[1] === text))).toBe(true);
    expect(words_of(text)).not.toEqual([]);
  });

  const modes = ["ready", "armed", "running", "fault"];
  it.each(modes)("explains the mode %s", (mode) => expect(words_of(mode)).toEqual([mode]));

  it("has the force, the torque and the singularity", () => {
    expect(words_of("force, torque, the singularity")).toEqual(["force", "torque", "singularity"]);
  });

  it("prefers the longer word, and whole ones", () => {
    expect(words_of("limits in conflict")).toEqual(["limits in conflict"]);
    expect(words_of("unlimited forceful twins")).toEqual([]);
  });

  it("does not take the arm of a robot for the button Arm", () => {
    expect(words_of("its share of the arm's weight")).toEqual([]);
    expect(words_of("Arm")).toEqual(["armed"]);
  });

  it("has each form once, and a sentence for each word", () => {
    const forms = WORDS.flatMap(({ word, also }) => [word, ...also]);
    expect(new Set(forms).size).toBe(forms.length);
    for (const { text } of WORDS) expect(text).toMatch(/^[A-Z].{20,}\.$/s);
  });
});
