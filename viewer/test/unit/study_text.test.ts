import { afterEach, describe, expect, it, vi } from "vitest";

import { name_and_question } from "../../src/study/items";
import { html_of } from "../../src/study/markdown";
import type { Form, OperatorState, Step } from "../../src/study/messages";
import { event_rows, exit_text, hint_text, missing_text, number_text, person_text, phase_text, step_text } from "../../src/study/operator_text";
import { clock_text, hand_link } from "../../src/study/screens";
import { words_of } from "../../src/study/words";
import { is_stop_of_container } from "../../src/stop_button";

const step = (kind: Step["kind"], more: Partial<Step> = {}): Step => ({ kind, is_done: false, ...more });
const STATE: OperatorState = {
  kind: "state",
  title: "Door",
  people: "real",
  hand: "mouse",
  participants: [],
  next: "P02",
  participant: null,
  participant_page: { link: "", is_connected: false, language: "en" },
  steps: [],
  position: null,
  phase: "closed",
  problem: null,
  run: null,
  last: null,
  notes: [],
  markers: [],
  can: [],
};

describe("texts of the operator's page", () => {
  it("name a step by what is done, and for what", () => {
    expect(step_text(step("trial", { condition: "door", repetition: 2 }))).toBe("Trial 2, door");
    expect(step_text(step("form", { condition: "door", form: "tlx" }))).toBe("Form, tlx, door");
    expect(step_text(step("break", { condition: null, repetition: null, form: null }))).toBe("Break");
  });

  it("say who is next, and what the participant does", () => {
    expect(phase_text(STATE)).toBe("Next: P02");
    expect(phase_text({ ...STATE, next: null })).toBe("No participant is left");
    const steps = [step("form", { form: "tlx" }), step("trial", { condition: "door", repetition: 1 })];
    const open = { ...STATE, participant: "P02", steps };
    expect(phase_text({ ...open, position: 0, phase: "participant" })).toBe("P02 answers");
    expect(phase_text({ ...open, position: 1, phase: "ready" })).toBe("Ready to start");
    expect(hint_text({ ...open, position: 1, phase: "failed" })).toBe(
      "P02, step 2 of 2: Trial 1, door. Start plays it again.",
    );
    expect(person_text({ code: "P02", conditions: [], status: "begun", done: 3, of: 9 })).toBe("begun, 3 of 9");
  });

  it("name what ended a trial", () => {
    expect([0, 1, 3, -9].map(exit_text)).toEqual([
      "ended well",
      "an event is missing or a limit was exceeded (exit code 1)",
      "a fault stopped the device (exit code 3)",
      "exit code -9",
    ]);
  });

  it("name the events that a trial lacks", () => {
    expect(missing_text(["closed"])).toBe("Missing event: closed");
    expect(missing_text(["opened", "closed"])).toBe("Missing events: opened, closed");
  });

  it("list expected events in their order, each happening once, then the others", () => {
    const events = [
      { time_s: 1, name: "touch" },
      { time_s: 2, name: "slip" },
      { time_s: 3, name: "touch" },
    ];
    expect(event_rows({ events, expected_events: ["touch", "open"] })).toEqual([
      { name: "touch", time_s: 1, is_expected: true },
      { name: "open", time_s: null, is_expected: true },
      { name: "slip", time_s: 2, is_expected: false },
      { name: "touch", time_s: 3, is_expected: false },
    ]);
  });

  it("show measures with four digits, and say when there is none", () => {
    expect([11.9716, 0, 1e-5, null].map(number_text)).toEqual(["11.97", "0", "1.00e-5", "no value"]);
  });
});

describe("texts of the participant's page", () => {
  it("are there in both languages", () => {
    const [english, german] = [words_of("en"), words_of("de")];
    for (const [name, word] of Object.entries(english)) {
      const other = german[name as keyof typeof german];
      if (typeof word === "string") expect(other, name).not.toBe(word);
    }
    expect(words_of("fr")).toBe(english);
    expect(german.missing(2)).toBe("2 Antworten fehlen.");
  });

  it("count a break down to zero", () => {
    expect([120, 95.2, 59.01, 0.2, 0, -3].map(clock_text)).toEqual(["2:00", "1:36", "1:00", "0:01", "0:00", "0:00"]);
  });

  it("take the name of a TLX scale from its question", () => {
    const form: Form = { name: "tlx", kind: "nasa_tlx", about: "", items: [], pairs: [] };
    const item = { name: "effort", kind: "slider", text: "Effort: how hard?", low: 0, high: 100, step: 5, ends: [] } as const;
    expect(name_and_question(form, { ...item, ends: [] })).toEqual(["Effort", "how hard?"]);
    expect(name_and_question({ ...form, kind: "own" }, { ...item, ends: [] })).toEqual(["", "Effort: how hard?"]);
  });

  it("show the handle alone", () => {
    expect(hand_link("http://127.0.0.1:80/#token=ab", "de")).toBe("http://127.0.0.1:80/#token=ab&show=hand&language=de");
  });
});

describe("Markdown of a study", () => {
  it("is shown without its HTML and without scripts in links", () => {
    const html = html_of("# Door\n\n**Open** it. <b onclick='x()'>now</b> <script>alert(1)</script> [go](javascript:alert(1))");
    expect(html).toContain("<h2>Door</h2>");
    expect(html).toContain("<strong>Open</strong>");
    expect(html).not.toMatch(/<script|<b |onclick|javascript/);
  });
});

describe("the stop of a page that shows this one inside itself", () => {
  afterEach(() => vi.unstubAllGlobals());

  it("is taken from that page only", () => {
    const container = {};
    vi.stubGlobal("window", { parent: container });
    expect(is_stop_of_container(container, "emergency stop")).toBe(true);
    expect(is_stop_of_container({}, "emergency stop")).toBe(false);
    expect(is_stop_of_container(container, "release")).toBe(false);
  });

  it("is not taken by a page of its own", () => {
    const alone: { parent?: unknown } = {};
    alone.parent = alone;
    vi.stubGlobal("window", alone);
    expect(is_stop_of_container(alone, "emergency stop")).toBe(false);
  });
});
