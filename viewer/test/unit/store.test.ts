import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { Store } from "../../src/data/store";
import type { Frame, Scene, Values } from "../../src/messages";
import { frame, scene } from "./examples";

class FakeSocket {
  static OPEN = 1;
  static all: FakeSocket[] = [];
  readyState = 0;
  onopen = (): void => {};
  onclose = (): void => {};
  onmessage: (event: { data: string }) => void = () => {};
  constructor() {
    FakeSocket.all.push(this);
  }
  open(): void {
    this.readyState = 1;
    this.onopen();
  }
  close(): void {
    this.readyState = 3;
    this.onclose();
  }
  receive(message: Frame | Values): void {
    this.onmessage({ data: JSON.stringify(message) });
  }
}

const SETTING = {
  name: "hinge.damping",
  group: "hinge",
  label: "",
  unit: "",
  min: 0,
  max: 9,
  value: 2,
  step: 0,
  help: "",
};

describe("Store", () => {
  let served: Scene;

  beforeEach(() => {
    vi.useFakeTimers();
    served = { ...scene, settings: [SETTING] };
    FakeSocket.all = [];
    vi.stubGlobal("WebSocket", FakeSocket);
    vi.stubGlobal("location", { host: "127.0.0.1:1" });
    vi.stubGlobal("sessionStorage", { getItem: () => "1f" });
    vi.stubGlobal("fetch", async () => ({ ok: true, json: async () => served }));
  });
  afterEach(() => {
    vi.unstubAllGlobals();
    vi.useRealTimers();
  });

  const rest = (): Promise<unknown> => vi.advanceTimersByTimeAsync(0);
  const newest = (): FakeSocket => FakeSocket.all.at(-1)!;

  it("passes values on that came before their scene", async () => {
    const store = new Store();
    const reported: string[] = [];
    store.subscribe({
      on_scene: () => reported.push("scene"),
      on_values: ({ values }) => reported.push(`values ${values[0]}`),
    });
    newest().open();
    newest().receive({ type: "values", values: [7] });
    await rest();
    expect(reported).toEqual(["scene", "values 7"]);
  });

  it("fetches the scene of a new run and drops frames of the old one", async () => {
    const store = new Store();
    newest().open();
    await rest();
    newest().receive(frame);
    expect(store.frame?.run).toBe(3);
    served = { ...served, run: 4, title: "Excavator" };
    newest().receive({ ...frame, run: 4 });
    await rest();
    expect(store.scene?.title).toBe("Excavator");
    expect(store.frame).toBeNull();
    newest().receive(frame); // of the old run
    expect(store.frame).toBeNull();
  });

  it("connects again, and again", async () => {
    const store = new Store();
    newest().open();
    for (let connections = 2; connections < 5; connections++) {
      newest().close();
      expect(store.is_connected).toBe(false);
      await vi.advanceTimersByTimeAsync(2000);
      expect(FakeSocket.all).toHaveLength(connections);
    }
    newest().open();
    await rest();
    newest().receive(frame);
    expect(store.frame?.time_s).toBe(frame.time_s);
  });

  it("does not take frames that do not fit the scene", async () => {
    const store = new Store();
    newest().open();
    await rest();
    newest().receive({ ...frame, q_device: [1] });
    expect(store.frame).toBeNull();
    expect(store.unreadable).toBe(1);
  });

  it("resets the history when time goes back", async () => {
    const store = new Store();
    newest().open();
    await rest();
    for (const time_s of [1, 2, 2, 0.5]) newest().receive({ ...frame, time_s });
    expect([...store.history.column("time_s")]).toEqual([0.5]);
  });
});
