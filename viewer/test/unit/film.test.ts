import { Vector3 } from "three";
import { afterEach, beforeEach, expect, it, vi } from "vitest";

import type { Store } from "../../src/data/store";
import { Film } from "../../src/film";
import { asked_view, view_text } from "../../src/scene/asked_view";
import { frame } from "./examples";

// A program that has the recording: it answers a seek with a frame, if it is asked for one.
function program() {
  const sent: [string, number][] = [];
  let listener: Record<string, (message: never) => void> = {};
  const store = {
    frame: null as unknown,
    commands: { send: (name: string, _: string, value = 0) => void sent.push([name, value]) },
    subscribe: (found: typeof listener) => void (listener = found),
  };
  const give = (position_s: number, is_paused = true): void => {
    store.frame = { ...frame, run_state: { ...frame.run_state, position_s, is_paused } };
    listener.on_frame!(store.frame as never);
  };
  const refuse = (reason: string): void => listener.on_refusal!({ reason } as never);
  return { sent, give, refuse, store: store as unknown as Store };
}

beforeEach(() => {
  vi.useFakeTimers();
  const part = () => ({ append: () => undefined, textContent: "" });
  vi.stubGlobal("document", { createElement: part, getElementById: part, body: { dataset: {} } });
  vi.stubGlobal("location", { hash: "#show=picture" });
  vi.stubGlobal("requestAnimationFrame", (draw: () => void) => void draw());
});

afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

it("a picture is drawn once the frame of its time has come, and no other is taken for it", async () => {
  const { sent, give, store } = program();
  const painted: number[] = [];
  const film = new Film(store, () => undefined, () => painted.push(1));
  const drawn = film.draw(2.5);
  await vi.advanceTimersByTimeAsync(100);
  expect(sent).toEqual([["pause", 0], ["seek", 2.5]]); // a recording that plays has gone on when it is drawn
  give(2.49);
  give(2.5, false);
  await vi.advanceTimersByTimeAsync(0);
  expect(painted).toEqual([]);
  give(2.500001); // rounded on its way
  await drawn;
  expect(painted).toEqual([1]);
});

it("what eases from picture to picture has as many of them as on a screen", async () => {
  const { give, store } = program();
  let prepared = 0;
  const film = new Film(store, () => (prepared += 1), () => undefined);
  const count = async (time_s: number): Promise<number> => {
    prepared = 0;
    const passed = film.pass(time_s);
    await vi.advanceTimersByTimeAsync(100);
    give(time_s);
    await passed;
    return prepared;
  };
  expect(await count(1)).toBe(60); // whatever it was, it rests
  expect(await count(1.1)).toBe(6);
  expect(await count(1.1)).toBe(1);
});

it("the program is not asked more often than it answers, and a refusal is the reason", async () => {
  const { sent, give, refuse, store } = program();
  const film = new Film(store, () => undefined, () => undefined);
  const first = film.pass(1);
  await vi.advanceTimersByTimeAsync(0);
  give(1);
  await first;
  const second = film.pass(2);
  await vi.advanceTimersByTimeAsync(20);
  expect(sent.length).toBe(2);
  await vi.advanceTimersByTimeAsync(20);
  expect(sent.length).toBe(3);
  const failed = expect(second).rejects.toThrow("the recording has 0 .. 1 s");
  refuse("the recording has 0 .. 1 s");
  await failed;
});

it("the address names a view, or an eye and where it looks", () => {
  expect(asked_view("first-person")).toBe("first person");
  expect(asked_view("1,-2.5,3:0,0,1")).toEqual({ from: new Vector3(1, -2.5, 3), at: new Vector3(0, 0, 1) });
  for (const text of ["", "behind", "1,2,3", "1,2:3,4", "1,2,3:4,5,6:7,8,9", "1.2.3,4,5:0,0,1"]) {
    expect(asked_view(text), text).toBe(null);
  }
  const place = { from: new Vector3(1.25, 2, -3), at: new Vector3(0, 0, 1) };
  expect(asked_view(view_text(place))).toEqual(place);
});
