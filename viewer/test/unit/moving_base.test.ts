// The place of a twin that moves: where twin and surroundings are drawn, and what is said about it.
import { Vector3 } from "three";
import { describe, expect, it, vi } from "vitest";

import { base_text } from "../../src/base_text";
import { history_of, row_of } from "../../src/data/history";
import type { TwinBase } from "../../src/messages";
import { time_specs } from "../../src/plots/specs";
import { ChainView } from "../../src/scene/chain_view";
import { MovingBaseView } from "../../src/scene/moving_base";
import { frame, scene as still_scene } from "./examples";

const scene = { ...still_scene, twin_base_moves: true };
const half = Math.sin(Math.PI / 4);
const base: TwinBase = {
  p_B_m: [0, 0.03, 0.04],
  quaternion_B: [half, 0, 0, half], // a quarter turn about x
  v_m_per_s: [0, 0, 0.1],
  omega: [0, 0, 0],
  a: [0, 0, 0],
};

vi.hoisted(() => vi.stubGlobal("matchMedia", () => ({ matches: false }))); // of the theme

describe("a moving base", () => {
  it("carries the root link of the twin, and lets go of it where it rests", () => {
    const twin = new ChainView(scene.twin, "", () => {});
    const place = (): number[] => twin.placement.localToWorld(new Vector3(0, 0, 1)).toArray();
    twin.pose([0.4], base);
    twin.placement.updateMatrixWorld(true);
    const [x, y, z] = place();
    expect(x).toBeCloseTo(0);
    expect(y).toBeCloseTo(0.03 - 1);
    expect(z).toBeCloseTo(0.04);
    twin.pose([0.4]);
    twin.placement.updateMatrixWorld(true);
    expect(place()).toEqual([0, 0, 1]);
  });

  it("carries the deck, which rests at the floor, and leaves the outline where it is", () => {
    const view = new MovingBaseView(scene.twin, scene.floor_z_m);
    const [carried, outline] = view.group.children;
    const deck = carried!.children[0]!;
    const place = (): number => {
      view.group.updateMatrixWorld(true);
      return deck.getWorldPosition(new Vector3()).z;
    };
    expect(place()).toBeCloseTo(scene.floor_z_m);
    view.show({ ...base, quaternion_B: [0, 0, 0, 1] });
    expect(place()).toBeCloseTo(scene.floor_z_m + 0.04);
    expect(outline!.getWorldPosition(new Vector3()).z).toBeCloseTo(scene.floor_z_m, 1);
    view.show(null);
    expect(place()).toBeCloseTo(scene.floor_z_m);
  });

  it("is described by its way, turn and speed, and not where there is none", () => {
    const text = base_text(scene, base);
    expect(text).toContain("50 mm and 90.0\u00b0 from where it rests, at 10 cm/s");
    expect(base_text(still_scene, base)).toBe("");
    expect(base_text(scene, null)).toBe("");
  });

  it("has columns in the history and a plot, only where it moves", () => {
    const table = history_of(scene);
    table.push(row_of(scene, { ...frame, twin_base: base }));
    expect(table.last("base_z_m")).toBe(0.04);
    expect(table.last("base_v_z_m_per_s")).toBe(0.1);
    expect(time_specs(scene).map(({ id }) => id)).toContain("twin-base");
    expect(history_of(still_scene).names).not.toContain("base_z_m");
    expect(time_specs(still_scene).map(({ id }) => id)).not.toContain("twin-base");
  });
});
