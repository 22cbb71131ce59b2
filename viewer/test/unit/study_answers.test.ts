import { describe, expect, it } from "vitest";

import { all_answers, drawn, DraftStore, forget_other_drafts, missing_items, name_of_pair, owner_of } from "../../src/study/answers";
import type { Form, Item, Pair } from "../../src/study/messages";

const item = (name: string, kind: Item["kind"]): Item => ({ name, kind, text: name, low: 0, high: 100, step: 5, ends: [] });
const PAIRS: Pair[] = [["a", "b"], ["a", "c"], ["b", "c"]];
const FORM: Form = {
  name: "tlx",
  kind: "own",
  about: "",
  items: [item("a", "slider"), item("b", "likert"), item("c", "text")],
  pairs: PAIRS,
};

class Kept implements Storage {
  private readonly kept = new Map<string, string>();
  get length(): number {
    return this.kept.size;
  }
  key(i: number): string | null {
    return [...this.kept.keys()][i] ?? null;
  }
  getItem(name: string): string | null {
    return this.kept.get(name) ?? null;
  }
  setItem(name: string, value: string): void {
    this.kept.set(name, value);
  }
  removeItem(name: string): void {
    this.kept.delete(name);
  }
  clear(): void {
    this.kept.clear();
  }
}

function random_of(seed: number): () => number {
  let state = seed;
  return () => (state = (state * 16807) % 2147483647) / 2147483647;
}

describe("answers of a form", () => {
  it("are missing until they are given, also when they are 0; a text may be left out", () => {
    expect(missing_items(FORM, {}).map(({ name }) => name)).toEqual(["a", "b"]);
    expect(missing_items(FORM, { a: 0 }).map(({ name }) => name)).toEqual(["b"]);
    expect(missing_items(FORM, { a: 0, b: 1 })).toEqual([]);
  });

  it("have an empty text where none was written", () => {
    expect(all_answers(FORM, { a: 0, b: 1 })).toEqual({ a: 0, b: 1, c: "" });
    expect(all_answers(FORM, { a: 5 })).toEqual({ a: 5, c: "" });
  });
});

describe("drawn pairs", () => {
  it("are all pairs, each once", () => {
    for (let seed = 1; seed < 200; seed++) {
      const names = drawn(PAIRS, random_of(seed)).map((pair) => [...pair].sort().join());
      expect(names.sort()).toEqual(["a,b", "a,c", "b,c"]);
    }
  });

  it("come in every order and either way round, about equally often", () => {
    const first = new Map<string, number>();
    for (let seed = 1; seed <= 6000; seed++) {
      const pair = drawn(PAIRS, random_of(7919 * seed))[0]!.join();
      first.set(pair, (first.get(pair) ?? 0) + 1);
    }
    expect(first.size).toBe(6);
    for (const count of first.values()) expect(Math.abs(count - 1000)).toBeLessThan(150);
  });

  it("are named as the server named them, whichever way round", () => {
    expect(name_of_pair(FORM, ["c", "a"])).toBe("a/c");
    expect(name_of_pair(FORM, ["a", "c"])).toBe("a/c");
  });
});

describe("drafts", () => {
  it("are found again, with the order that was drawn", () => {
    const storage = new Kept();
    const store = new DraftStore("P01", 3, FORM, storage, random_of(1));
    store.draft.answers.a = 15;
    store.keep();
    const again = new DraftStore("P01", 3, FORM, storage, random_of(2));
    expect(again.draft).toEqual(store.draft);
  });

  it("belong to a person, a place and a form", () => {
    const storage = new Kept();
    const store = new DraftStore("P01", 3, FORM, storage);
    store.draft.answers.a = 15;
    store.keep();
    for (const [code, position, name] of [["P02", 3, "tlx"], ["P01", 4, "tlx"], ["P01", 3, "sus"]] as const) {
      expect(new DraftStore(code, position, { ...FORM, name }, storage).draft.answers).toEqual({});
    }
  });

  it("of a rehearsal are not those of the study with the same code", () => {
    const storage = new Kept();
    const [rehearsed, real] = ["abc script", "abc device"].map((draft) => owner_of({ draft, code: "P01" } as never));
    const store = new DraftStore(rehearsed!, 3, FORM, storage);
    store.draft.answers.mental = 5;
    store.keep();
    expect(new DraftStore(real!, 3, FORM, storage).draft.answers).toEqual({});
    forget_other_drafts(rehearsed!, 4, storage);
    expect(storage.length).toBe(0);
  });

  it("of steps that are over are forgotten, those of others are not", () => {
    const storage = new Kept();
    for (const [code, position] of [["P01", 3], ["P01", 4], ["P02", 3]] as const) {
      new DraftStore(code, position, FORM, storage).keep();
    }
    storage.setItem("other", "kept");
    forget_other_drafts("P01", 4, storage);
    const names = Array.from({ length: storage.length }, (_, i) => storage.key(i));
    expect(names).toEqual(["hapticgiant.draft.P01.4.tlx", "hapticgiant.draft.P02.3.tlx", "other"]);
  });
});
