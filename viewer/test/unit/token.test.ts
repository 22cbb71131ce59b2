import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { authorization, page_options, protocols, token, watch_token } from "../../src/data/token";

describe("token", () => {
  let kept: Map<string, string>;
  let on_hash: () => void;
  const address = { hash: "", pathname: "/", search: "", reload: vi.fn() };

  beforeEach(() => {
    kept = new Map();
    address.reload.mockClear();
    vi.stubGlobal("location", address);
    vi.stubGlobal("sessionStorage", {
      getItem: (name: string) => kept.get(name) ?? null,
      setItem: (name: string, value: string) => kept.set(name, value),
    });
    vi.stubGlobal("history", {
      replaceState: (_state: unknown, _title: string, to: string) => {
        address.hash = new URL(to, "http://here").hash;
      },
    });
    vi.stubGlobal("addEventListener", (_name: string, listener: () => void) => {
      on_hash = listener;
    });
  });
  afterEach(() => vi.unstubAllGlobals());

  it("leaves the address at once, and options stay in it", () => {
    address.hash = "#token=1f&quality=fast";
    watch_token();
    expect(address.hash).toBe("#quality=fast");
    expect(page_options().get("quality")).toBe("fast");
    expect(authorization()).toEqual({ Authorization: "Bearer 1f" });
    expect(protocols()).toEqual(["hapticgiant", "token.1f"]);
    expect(address.reload).not.toHaveBeenCalled();
  });

  it("survives a reload of its tab, and is not in another tab", () => {
    address.hash = "#token=1f";
    watch_token();
    watch_token();
    expect(token()).toBe("1f");
    kept.clear();
    expect(token()).toBe("");
  });

  it("is another one when a new link is opened in the same tab", () => {
    address.hash = "#token=1f";
    watch_token();
    address.hash = "#quality=best";
    on_hash();
    expect(address.reload).not.toHaveBeenCalled();
    address.hash = "#token=2e";
    on_hash();
    expect(address.hash).toBe("");
    expect(token()).toBe("2e");
    expect(address.reload).toHaveBeenCalledOnce();
  });
});
