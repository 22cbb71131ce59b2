// Gives back what the graphics hold of objects that are not drawn any more.

import { type Material, type Object3D, Texture } from "three";

// Shapes, materials and pictures of `root` and everything in it.
export function dispose_of(root: Object3D): void {
  root.traverse((part) => {
    const { geometry, material } = part as {
      geometry?: { dispose(): void };
      material?: Material | Material[];
    };
    geometry?.dispose();
    for (const one of [material ?? []].flat()) {
      for (const value of Object.values(one)) if (value instanceof Texture) value.dispose();
      one.dispose();
    }
  });
}
