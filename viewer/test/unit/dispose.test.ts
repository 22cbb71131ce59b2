import { BoxGeometry, Group, Mesh, MeshBasicMaterial, Texture } from "three";
import { expect, it } from "vitest";

import { dispose_of } from "../../src/scene/dispose";

it("gives back shapes, materials and pictures at any depth", () => {
  const freed: string[] = [];
  type Thing = Texture | MeshBasicMaterial | BoxGeometry;
  const noted = <T extends Thing>(thing: T, name: string): T => {
    (thing as Texture).addEventListener("dispose", () => freed.push(name));
    return thing;
  };
  const map = noted(new Texture(), "picture");
  const material = noted(new MeshBasicMaterial({ map }), "material");
  const second = noted(new MeshBasicMaterial(), "second");
  const mesh = new Mesh(noted(new BoxGeometry(), "shape"), [material, second]);
  dispose_of(new Group().add(new Group().add(mesh)));
  expect(freed.sort()).toEqual(["material", "picture", "second", "shape"]);
});
