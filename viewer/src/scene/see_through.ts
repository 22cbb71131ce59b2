// What stands between the eye and the hand or the arm fades while it does: the leaf of a door, a
// wall, the person; and beams of a gantry that are close to the eye. The arm never fades.

import { Box3, Matrix4, Mesh, type MeshStandardMaterial, type Object3D, Ray, Vector3 } from "three";

const FADED = 0.22; // share of its opacity
const SHARE = 0.15; // of the way per picture
const CLOSE = 0.55; // of the way to the hand
const BESIDE = 0.05; // m: what a point lies in does not hide it
const SOLID = 0.4; // opacity above which something hides what is drawn after it

interface Body {
  meshes: Mesh[];
  materials: MeshStandardMaterial[];
  opacities: number[]; // of the materials, when nothing lies behind
  is_frame: boolean; // fades when it is close, whatever it hides
  shown: number; // share of that
}

export class SeeThrough {
  private readonly bodies: Body[] = [];

  // All shapes of a link of a chain fade together; those of its root, which stands, each alone.
  add_links(root: Object3D): void {
    const links = new Map<Object3D, Mesh[]>();
    root.traverse((part) => {
      if (!(part instanceof Mesh)) return;
      const link = link_of(part, root);
      links.set(link, [...(links.get(link) ?? []), part]);
    });
    for (const meshes of links.values()) this.add(meshes);
  }

  // Every shape under `root`, but not those under `arm`, fades when it is close to the eye.
  add_frame(root: Object3D, arm: Object3D): void {
    if (root === arm) return;
    if (root instanceof Mesh) {
      (root.material as MeshStandardMaterial).transparent = true;
      this.add([root], true);
    }
    for (const part of root.children) this.add_frame(part, arm);
  }

  // All shapes under `roots` fade together.
  add_whole(roots: Object3D[]): void {
    const meshes: Mesh[] = [];
    for (const root of roots) root.traverse((part) => part instanceof Mesh && meshes.push(part));
    this.add(meshes);
  }

  // `points`: what must be seen, in B; the hand is the first.
  update(eye: Vector3, points: Vector3[]): void {
    const close = CLOSE * eye.distanceTo(points[0]!);
    for (const body of this.bodies) {
      const hides = body.is_frame
        ? distance_to(body.meshes[0]!, eye) < close
        : body.meshes.some((mesh) => points.some((point) => is_between(mesh, eye, point)));
      const wanted = hides ? FADED : 1;
      if (Math.abs(wanted - body.shown) < 0.01) continue;
      body.shown += SHARE * (wanted - body.shown);
      for (const [i, material] of body.materials.entries()) {
        material.opacity = body.shown * body.opacities[i]!;
        material.depthWrite = body.shown > SOLID;
      }
    }
  }

  private add(meshes: Mesh[], is_frame = false): void {
    const all = meshes.flatMap(({ material }) => material as MeshStandardMaterial[]);
    const materials = [...new Set(all)].filter(({ transparent }) => transparent);
    if (materials.length === 0) return;
    const opacities = materials.map(({ opacity }) => opacity);
    this.bodies.push({ meshes, materials, opacities, is_frame, shown: 1 });
  }
}

function link_of(part: Object3D, root: Object3D): Object3D {
  let link = part;
  while (link !== root && link.parent && !("isURDFLink" in link)) link = link.parent;
  return "isURDFRobot" in link ? part : link;
}

function box_of({ geometry }: Mesh): Box3 {
  if (!geometry.boundingBox) geometry.computeBoundingBox();
  return geometry.boundingBox!;
}

// From the eye to the box of a shape, m.
function distance_to(mesh: Mesh, eye: Vector3): number {
  const into = new Matrix4().copy(mesh.matrixWorld).invert();
  const inside = eye.clone().applyMatrix4(into);
  const nearest = box_of(mesh).clampPoint(inside, new Vector3());
  return nearest.applyMatrix4(mesh.matrixWorld).distanceTo(eye);
}

// Whether the box of a shape lies between the eye and a point.
export function is_between(mesh: Mesh, eye: Vector3, point: Vector3): boolean {
  const into = new Matrix4().copy(mesh.matrixWorld).invert();
  const [from, to] = [point.clone().applyMatrix4(into), eye.clone().applyMatrix4(into)];
  const away = to.clone().sub(from);
  const whole = away.length();
  const beside = (BESIDE * whole) / Math.max(1e-9, eye.distanceTo(point));
  const box = box_of(mesh);
  const ray = new Ray(from.addScaledVector(away.divideScalar(whole), beside), away);
  if (box.containsPoint(ray.origin)) return true;
  const met = ray.intersectBox(box, new Vector3());
  return met !== null && met.distanceTo(ray.origin) < whole - beside;
}
