import { PerspectiveCamera, Vector3 } from "three";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { CameraView } from "../../src/hand/camera_view";
import { Drag } from "../../src/hand/drag";
import type { Hand, Vec3 } from "../../src/messages";
import { frame } from "./examples";

const HANDLE_PX = { x: 100, y: 100 };

// A page of 200 x 200 pixels whose middle is the handle.
describe("Drag", () => {
  let area: EventTarget;
  let page: EventTarget;
  let sent: Hand[];
  let drag: Drag;
  const controls = { enabled: true };

  beforeEach(() => {
    vi.useFakeTimers();
    area = new EventTarget();
    page = new EventTarget();
    sent = [];
    controls.enabled = true;
    vi.stubGlobal("addEventListener", page.addEventListener.bind(page));
    vi.stubGlobal("document", Object.assign(new EventTarget(), { hidden: false }));
    const p_B_H_m: Vec3 = [0, 0, 0];
    const camera = new PerspectiveCamera(40, 1, 0.1, 10);
    camera.up.set(0, 0, 1);
    camera.position.set(0, -2, 2);
    camera.lookAt(new Vector3());
    camera.updateMatrixWorld();
    const canvas = {
      parentElement: area,
      style: {},
      setPointerCapture: () => {},
      getBoundingClientRect: () => ({ left: 0, top: 0, width: 200, height: 200 }),
    };
    const stage = { canvas, camera, on_screen: () => HANDLE_PX } as never;
    drag = new Drag(
      new CameraView(stage, { controls, current: "orbit" } as never),
      () => ({ ...frame, p_B_H_m, quaternion_B_H: [0, 0, 0, 1] }),
      (hand) => sent.push(hand),
    );
  });
  afterEach(() => {
    vi.clearAllTimers();
    vi.unstubAllGlobals();
    vi.useRealTimers();
  });

  function point(type: string, pointerId: number, x: number, y: number): void {
    const event = Object.assign(new Event(type), { pointerId, button: 0, clientX: x, clientY: y });
    (type === "pointerup" || type === "pointercancel" ? page : area).dispatchEvent(event);
  }

  it("takes the handle, moves it with the pointer, and lets go", () => {
    point("pointerdown", 1, 110, 100);
    expect(drag.is_dragging).toBe(true);
    expect(sent.at(-1)).toMatchObject({ active: true, p_B_m: [0, 0, 0] });
    point("pointermove", 1, 110, 60);
    expect(drag.target_m![1]).toBeGreaterThan(0.1);
    expect(drag.target_m![2]).toBeCloseTo(0);
    point("pointerup", 1, 110, 60);
    expect(sent.at(-1)!.active).toBe(false);
    expect(drag.target_m).toBeNull();
  });

  it("leaves what is not at the handle to the camera", () => {
    point("pointerdown", 1, 160, 100);
    expect(drag.is_dragging).toBe(false);
  });

  it("does not take the handle with the second finger of a pinch", () => {
    point("pointerdown", 1, 20, 20);
    point("pointerdown", 2, 100, 100);
    expect(drag.is_dragging).toBe(false);
    point("pointerup", 1, 20, 20);
    point("pointerup", 2, 100, 100);
    point("pointerdown", 3, 100, 100);
    expect(drag.is_dragging).toBe(true);
  });

  it("turns the handle by the wheel while it is dragged, and moves it on", () => {
    const wheel = (deltaY: number): void => void area.dispatchEvent(Object.assign(new Event("wheel"), { deltaY }));
    wheel(-100); // nothing is held
    expect(sent).toHaveLength(0);
    point("pointerdown", 1, 100, 100);
    for (let i = 0; i < 3; i++) wheel(-100);
    const [, , z, w] = sent.at(-1)!.quaternion_B_H!;
    expect(2 * Math.atan2(z, w)).toBeCloseTo(3 * 0.064); // to the left, seen from above
    point("pointermove", 1, 100, 60);
    expect(drag.target_m![1]).toBeGreaterThan(0.1);
    wheel(100);
    expect(2 * Math.atan2(sent.at(-1)!.quaternion_B_H![2], sent.at(-1)!.quaternion_B_H![3])).toBeCloseTo(2 * 0.064);
  });

  it("drops a held key when the page loses the keyboard", () => {
    drag.key_mode = "turn";
    point("pointerdown", 1, 100, 100);
    page.dispatchEvent(new Event("blur"));
    expect(drag.mode).toBe("plane");
    expect(sent.at(-1)!.active).toBe(false);
  });

  it("repeats itself while it holds, as a sign of life", () => {
    point("pointerdown", 1, 100, 100);
    const before = sent.length;
    vi.advanceTimersByTime(300);
    expect(sent.length).toBeGreaterThan(before + 5);
    drag.release();
    const after = sent.length;
    vi.advanceTimersByTime(300);
    expect(sent.length).toBe(after);
  });
});
