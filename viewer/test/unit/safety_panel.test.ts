import { beforeEach, describe, expect, it, vi } from "vitest";

import type { Commands } from "../../src/data/commands";
import type { Frame, Safety, Scene } from "../../src/messages";
import { SafetyPanel } from "../../src/panels/safety";
import { frame } from "./examples";

// As much of an element as the panel uses.
class FakeElement extends EventTarget {
  textContent = "";
  className = "";
  title = "";
  type = "";
  hidden = false;
  checked = false;
  dataset: Record<string, string> = {};
  readonly attributes = new Map<string, string>();
  readonly children: FakeElement[] = [];

  constructor(readonly tag: string) {
    super();
  }
  append(...parts: (FakeElement | string)[]): void {
    for (const part of parts) {
      if (typeof part === "string") this.textContent += part;
      else this.children.push(part);
    }
  }
  setAttribute(name: string, value: string): void {
    this.attributes.set(name, value);
  }
  querySelector(tag: string): FakeElement | null {
    return this.all().find((part) => part.tag === tag) ?? null;
  }
  all(): FakeElement[] {
    return this.children.flatMap((child) => [child, ...child.all()]);
  }
}

const OWN_PAGE = 4;

describe("SafetyPanel", () => {
  let section: FakeElement;
  let panel: SafetyPanel;
  const send = vi.fn();

  beforeEach(() => {
    send.mockClear();
    vi.stubGlobal("document", {
      activeElement: null,
      createElement: (tag: string) => new FakeElement(tag),
    });
    section = new FakeElement("section");
    panel = new SafetyPanel(section as never, { send } as unknown as Commands, () => OWN_PAGE);
    panel.load({ commands: ["panel", "mode", "emergency_stop"] } as unknown as Scene);
  });

  const show = (safety: Partial<Safety>, mode: Frame["mode"] = "running"): void => {
    panel.show({ ...frame, mode, safety: { ...frame.safety, ...safety } });
  };
  const texts = (): string[] => section.all().map((part) => part.textContent);
  const is_hidden = (text: string): boolean => {
    const holds = (part: FakeElement): boolean =>
      part.textContent === text || part.children.some(holds);
    return section.all().some((part) => part.hidden && holds(part));
  };
  const box_of = (text: string): FakeElement =>
    section.all().find((part) => part.textContent === text)!.querySelector("input")!;

  it("follows the machine although the box was just clicked", () => {
    const box = box_of("Override key");
    vi.stubGlobal("document", { activeElement: box });
    show({ override_key: true });
    expect(box.checked).toBe(true);
    show({ override_key: false });
    expect(box.checked).toBe(false);
  });

  it("sends what is clicked", () => {
    const box = box_of("Enabling switch held");
    box.checked = false;
    box.dispatchEvent(new Event("change"));
    const button = section.all().find((part) => part.textContent === "Emergency stop")!;
    button.dispatchEvent(new Event("click"));
    show({ emergency_stop: true, stop_pressed_by: [OWN_PAGE] });
    button.dispatchEvent(new Event("click"));
    expect(send.mock.calls).toEqual([
      ["panel", "operator_enable", 0],
      ["emergency_stop"],
      ["release_stop", "", OWN_PAGE],
    ]);
    expect(button.attributes.get("aria-pressed")).toBe("true");
  });

  it("asks before it releases the stop of another page", () => {
    const button = (text: string): FakeElement =>
      section.all().find((part) => part.tag === "button" && part.textContent === text)!;
    for (const [page, by] of [
      [7, "page 7"],
      [0, "the script"],
    ] as const) {
      const question = `The stop was pressed by ${by}. Release it?`;
      send.mockClear();
      show({ emergency_stop: true, stop_pressed_by: [page] });
      expect(is_hidden("Release it")).toBe(true);
      button("Emergency stop: pull it out").dispatchEvent(new Event("click"));
      expect(send).not.toHaveBeenCalled();
      expect(is_hidden("Release it")).toBe(false);
      expect(texts()).toContain(question);
      button("Leave it").dispatchEvent(new Event("click"));
      expect(is_hidden("Release it")).toBe(true);
      button("Emergency stop: pull it out").dispatchEvent(new Event("click"));
      button("Release it").dispatchEvent(new Event("click"));
      expect(send.mock.calls).toEqual([["release_stop", "", page]]);
    }
  });

  it("keeps the stop for a device that has no simulated panel", () => {
    panel.load({ commands: ["mode", "emergency_stop"] } as unknown as Scene);
    expect(is_hidden("Emergency stop")).toBe(false);
    expect(is_hidden("Override key")).toBe(true);
  });

  it("shows drives on after a stop, and off after a fault", () => {
    show({ stop: "SS2", fault: 0 }, "stopping");
    expect(texts()).toContain("braked, then held");
    show({ stop: "SS2", fault: 302 }, "stopping");
    expect(texts()).toContain("braked, then drives off");
  });

  it("marks the next step of the way back to running", () => {
    const marked = (): string[] =>
      section.all().flatMap((part) => (part.dataset.next === "true" ? [part.textContent] : []));
    show({ emergency_stop: true }, "fault");
    expect(marked()).toEqual(["Emergency stop: pull it out"]);
    show({}, "fault");
    expect(marked()).toEqual(["Reset"]);
    show({}, "ready");
    expect(marked()).toEqual(["Arm"]);
    show({}, "armed");
    expect(marked()).toEqual(["Run"]);
    show({}, "running");
    expect(marked()).toEqual([]);
    const run_state = { ...frame.run_state, is_over: true };
    panel.show({ ...frame, mode: "armed", run_state }); // nothing but a restart leads on
    expect(marked()).toEqual([]);
  });

  it("offers a recording no buttons", () => {
    const hidden = (): boolean[] => ["Emergency stop", "Reset"].map((text) => is_hidden(text));
    expect(hidden()).toEqual([false, false]);
    panel.load({ commands: ["seek"] } as unknown as Scene);
    expect(hidden()).toEqual([true, true]);
  });

  it("shows cause and release as sentences", () => {
    show({ fault: 308, cause: "308 They shake.", release: "at once; hold it less stiffly" }, "fault");
    expect(texts()).toContain("308 They shake.");
    expect(texts()).toContain("Release: at once; hold it less stiffly.");
  });
});
