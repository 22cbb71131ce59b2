// The second recording of a comparison: its device and twin in one see-through colour.

import { Group } from "three";

import type { Frame, Scene } from "../messages";
import { type ChainView, load_chain } from "./chain_view";
import { paint_ghost } from "./materials";

export class Ghost {
  readonly group = new Group();
  private chains: [ChainView, ChainView] | null = null;
  private is_asked_for = false;

  constructor(private readonly scene: Scene) {}

  show(ghost: Frame["ghost"]): void {
    if (ghost && !this.is_asked_for) void this.load();
    if (!this.chains) return;
    const [device, twin] = this.chains;
    device.placement.visible = twin.placement.visible = ghost !== null;
    if (!ghost) return;
    device.pose(ghost.q_device);
    twin.pose(ghost.q_twin, ghost.twin_base);
  }

  private async load(): Promise<void> {
    this.is_asked_for = true;
    const { device, twin } = this.scene;
    this.chains = await Promise.all([
      load_chain(device, paint_ghost),
      load_chain(twin, paint_ghost),
    ]);
    for (const { placement } of this.chains) this.group.add(placement);
  }
}
