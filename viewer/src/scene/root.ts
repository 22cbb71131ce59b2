// Where the root link of a chain is: at its placement, or where a moving base has carried it.

import type { Object3D } from "three";

import type { SceneChain, TwinBase } from "../messages";

export function put_at_root(part: Object3D, chain: SceneChain, base: TwinBase | null = null): void {
  const [x, y, z, w] = base?.quaternion_B ?? chain.quaternion_B_root;
  part.position.set(...(base?.p_B_m ?? chain.p_B_root_m));
  part.quaternion.set(x, y, z, w);
}
