import { beforeEach, describe, expect, it, vi } from "vitest";

import { Drag } from "../../src/hand/drag";
import type { HandView } from "../../src/hand/hand_view";
import { LARGEST_N, RISE_N_PER_S, in_base, offset_of, push_of } from "../../src/hand/key_push";
import { PushKeys } from "../../src/hand/push_keys";
import type { Hand, Vec3 } from "../../src/messages";
import { frame, scene } from "./examples";

const FULL_MS = (1000 * LARGEST_N) / RISE_N_PER_S;
const held = (...keys: [string, number][]): Map<string, number> => new Map(keys);

describe("the force of keys", () => {
  it("rises while a key is held, up to the largest", () => {
    const at = (now_ms: number): number => push_of(held(["KeyW", 0]), now_ms)[0];
    expect(at(0)).toBe(0);
    expect(at(0.5 * FULL_MS)).toBeCloseTo(0.5 * LARGEST_N);
    expect(at(FULL_MS)).toBeCloseTo(LARGEST_N);
    expect(at(10 * FULL_MS)).toBeCloseTo(LARGEST_N);
  });

  it("of several keys together is never above the largest, and opposite keys cancel", () => {
    const both = push_of(held(["KeyW", 0], ["ArrowRight", 0], ["KeyE", 0]), 10 * FULL_MS);
    expect(Math.hypot(...both)).toBeCloseTo(LARGEST_N);
    expect(Math.hypot(...push_of(held(["KeyA", 0], ["KeyD", 0]), FULL_MS))).toBe(0);
  });

  it("points as the viewer looks, level", () => {
    expect(in_base([1, 0, 0], [0, 1, -1])).toEqual([0, 1, 0]);
    expect(in_base([0, 1, 0], [0, 1, -1])).toEqual([1, 0, 0]);
    expect(in_base([1, 0, 2], [0, 0, -1])).toEqual([0, 1, 2]); // from above: up on the screen
  });

  it("becomes a distance by the stiffness of the arm, within its largest pull", () => {
    const stiffness: Vec3 = [250, 150, 0];
    expect(offset_of([25, 0, 5], stiffness, 60)).toEqual([0.1, 0, 0]);
    expect(offset_of([0, 30, 0], stiffness, 15)).toEqual([0, 0.1, 0]);
  });
});

class Key extends Event {
  readonly ctrlKey = false;
  readonly metaKey = false;
  readonly altKey = false;
  constructor(
    type: string,
    readonly code: string,
    readonly repeat = false,
  ) {
    super(type, { cancelable: true });
  }
}

describe("keys that push", () => {
  let page: EventTarget;
  let document: EventTarget & { hidden: boolean };
  let sent: Hand[];
  let drag: Drag;

  beforeEach(() => {
    vi.useFakeTimers();
    vi.unstubAllGlobals();
    vi.stubGlobal("HTMLElement", class {});
    vi.stubGlobal("HTMLInputElement", class {});
    vi.stubGlobal("HTMLSelectElement", class {});
    page = new EventTarget();
    document = Object.assign(new EventTarget(), { hidden: false });
    vi.stubGlobal("addEventListener", page.addEventListener.bind(page));
    vi.stubGlobal("document", document);
    sent = [];
    const view: HandView = {
      area: new EventTarget() as never,
      is_near: () => true,
      ray: () => ({ origin: [0, 0, 1], direction: [0, 0, -1] }),
      direction: () => [0, 1, 0],
      capture: () => {},
      release: () => {},
      show_cursor: () => {},
    };
    drag = new Drag(
      view,
      () => ({ ...frame, p_B_H_m: [0, 0, 0] }),
      (hand) => sent.push(hand),
    );
    new PushKeys(drag, view).load({ ...scene, hand_stiffness_N_per_m: [100, 100, 100], hand_force_max_N: 60 });
    sent.length = 0;
  });

  const press = (code: string): boolean => page.dispatchEvent(new Key("keydown", code));
  const lift = (code: string): boolean => page.dispatchEvent(new Key("keyup", code));

  it("pull the hand further the longer they are held, and let go at once", () => {
    press("KeyW");
    vi.advanceTimersByTime(500);
    const early = sent.at(-1)!;
    expect(early.active).toBe(true);
    vi.advanceTimersByTime(2000);
    expect(sent.at(-1)!.p_B_m[1]).toBeGreaterThan(early.p_B_m[1]);
    expect(sent.at(-1)!.p_B_m[1]).toBeCloseTo(LARGEST_N / 100);
    lift("KeyW");
    expect(sent.at(-1)!.active).toBe(false);
  });

  it.each([
    ["the window loses the focus", () => page.dispatchEvent(new Event("blur"))],
    [
      "the page is hidden",
      () => {
        document.hidden = true;
        document.dispatchEvent(new Event("visibilitychange"));
      },
    ],
  ])("let go when %s, until they are pressed again", (_, leave) => {
    press("ArrowUp");
    leave();
    expect(sent.at(-1)!.active).toBe(false);
    page.dispatchEvent(new Key("keydown", "ArrowUp", true)); // the keyboard repeats a held key
    vi.advanceTimersByTime(200);
    expect(sent.at(-1)!.active).toBe(false);
  });

  it("that are still down after the hand was let go push no more when another one is released", () => {
    press("KeyW");
    press("KeyD");
    vi.advanceTimersByTime(2000);
    drag.release();
    expect(sent.at(-1)!.active).toBe(false);
    sent.length = 0;
    lift("KeyD");
    vi.advanceTimersByTime(500);
    expect(sent).toEqual([]);
    press("KeyW");
    expect(sent.at(-1)!.active).toBe(true); // from nothing again
    expect(Math.hypot(...sent.at(-1)!.p_B_m)).toBe(0);
    lift("KeyW");
  });

  it("press the lever while they push, as a pointer that drags does", () => {
    drag.presses_while_dragging = true;
    press("KeyD");
    expect(sent.at(-1)!.press).toBe(1);
    lift("KeyD");
    expect(sent.at(-1)!.press).toBe(0);
  });

  it("say so and do nothing while another page has the hand", () => {
    let refusals = 0;
    drag.can_hold = false;
    drag.on_refused = () => (refusals += 1);
    press("KeyW");
    vi.advanceTimersByTime(500);
    expect(refusals).toBe(1);
    expect(sent).toEqual([]);
  });
});
