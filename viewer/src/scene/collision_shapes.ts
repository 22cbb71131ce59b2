// Shapes by which the device foresees that it hits itself, on its links: solid, but one can look
// into them.

import { BoxGeometry, type BufferGeometry, CapsuleGeometry, Mesh, MeshStandardMaterial } from "three";

import type { SceneShape } from "../messages";
import type { ChainView } from "./chain_view";

const COLOR = 0x1f9fd0;

// Adds the shapes to the links that they move with; those of unknown links are left out.
export function add_shapes(shapes: SceneShape[], device: Pick<ChainView, "link">): Mesh[] {
  const material = new MeshStandardMaterial({
    color: COLOR,
    roughness: 0.6,
    transparent: true,
    opacity: 0.4,
    depthWrite: false,
    polygonOffset: true, // before shapes of the URDF that are the same
    polygonOffsetFactor: -1,
    polygonOffsetUnits: -4,
  });
  const added: Mesh[] = [];
  for (const shape of shapes) {
    const link = device.link(shape.link);
    if (!link) continue;
    const mesh = new Mesh(geometry_of(shape), material);
    mesh.name = shape.name;
    mesh.position.set(...shape.p_link_m);
    mesh.quaternion.set(...shape.quaternion_link);
    link.add(mesh);
    added.push(mesh);
  }
  return added;
}

function geometry_of({ size_m, radius_m, length_m }: SceneShape): BufferGeometry {
  if (radius_m === 0) return new BoxGeometry(...size_m);
  return new CapsuleGeometry(radius_m, length_m, 10, 24).rotateX(Math.PI / 2);
}
