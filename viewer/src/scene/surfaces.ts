// Virtual surfaces: solid, but one can look into them. The one that pushes lights up, with its
// proxy as a ball and a line from the handle to it.

import {
  BoxGeometry,
  BufferGeometry,
  CylinderGeometry,
  DoubleSide,
  EdgesGeometry,
  Float32BufferAttribute,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshStandardMaterial,
  PlaneGeometry,
  SphereGeometry,
  Vector3,
} from "three";

import type { Contact, SceneSurface, Vec3 } from "../messages";
import { CONTACT_COLOR, SURFACE_COLOR } from "../theme";
import { Bar } from "./arrows";
import { glowing } from "./materials";

const PLANE_SIZE = 2; // m; of a plane without end
const FOLD = 20; // degrees; flatter edges are not drawn

export class SurfacesView {
  readonly group = new Group();
  private readonly materials: MeshStandardMaterial[] = [];
  private readonly contact = new Group();
  private readonly proxy: Mesh;
  private readonly spring: Bar;

  constructor(surfaces: SceneSurface[]) {
    for (const surface of surfaces) this.add(surface);
    const glow = glowing(CONTACT_COLOR);
    this.proxy = new Mesh(new SphereGeometry(0.012, 20, 12), glow);
    this.spring = new Bar(0.004, glow);
    this.contact.add(this.proxy, this.spring.mesh);
    this.group.add(this.contact);
  }

  show(p_B_E: Vec3, contact: Contact | null): void {
    this.contact.visible = contact !== null;
    for (const [index, material] of this.materials.entries()) {
      const is_touched = contact?.surface === index;
      material.color.set(is_touched ? CONTACT_COLOR : SURFACE_COLOR);
      material.opacity = is_touched ? 0.62 : 0.42;
    }
    if (!contact) return;
    this.proxy.position.set(...contact.proxy);
    this.spring.span(new Vector3(...p_B_E), this.proxy.position);
  }

  private add(surface: SceneSurface): void {
    const shape = shape_of(surface);
    const material = new MeshStandardMaterial({
      color: SURFACE_COLOR,
      roughness: 0.6,
      transparent: true,
      opacity: 0.42,
      side: DoubleSide,
      depthWrite: false,
    });
    const solid = new Mesh(shape, material);
    solid.name = surface.name;
    const lines = new LineBasicMaterial({ color: SURFACE_COLOR });
    solid.add(new LineSegments(new EdgesGeometry(shape, FOLD), lines));
    solid.position.set(...surface.p_B_m);
    solid.quaternion.set(...surface.quaternion_B);
    this.materials.push(material);
    this.group.add(solid);
  }
}

function shape_of({ shape, size_m, triangles_m }: SceneSurface): BufferGeometry {
  const [x, y, z] = size_m;
  switch (shape) {
    case "plane":
      return new PlaneGeometry(PLANE_SIZE, PLANE_SIZE);
    case "box":
      return new BoxGeometry(x, y, z);
    case "sphere":
      return new SphereGeometry(0.5 * x, 48, 24);
    case "cylinder":
      return new CylinderGeometry(0.5 * x, 0.5 * x, z, 48).rotateX(Math.PI / 2);
    case "mesh": {
      const mesh = new BufferGeometry();
      mesh.setAttribute("position", new Float32BufferAttribute(triangles_m, 3));
      mesh.computeVertexNormals();
      return mesh;
    }
  }
}
