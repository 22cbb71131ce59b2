// What things are made of: materials by the name that the URDF gives them.

import { type Material, Color, Mesh, MeshStandardMaterial, type Object3D } from "three";

import { DEVICE_COLOR, GHOST_COLOR, REMOTE_COLOR, TWIN_COLOR, current_theme } from "../theme";

// How the shapes of a chain are drawn.
interface Look {
  color: number; // that its own colours are mixed with
  share: number; // of it, 0..1
  opacity: number; // below 1 solid things behind stay visible
}

export const DEVICE: Look = { color: DEVICE_COLOR, share: 0.68, opacity: 1 };
export const TWIN: Look = { color: TWIN_COLOR, share: 0.6, opacity: 0.85 }; // it is not there
export const REMOTE: Look = { color: REMOTE_COLOR, share: 0.72, opacity: 1 };

interface Surface {
  roughness: number;
  metalness: number;
}

const SURFACES: [RegExp, Surface][] = [
  [/chrome|mirror/i, { roughness: 0.18, metalness: 0.95 }],
  [/steel|metal|iron/i, { roughness: 0.38, metalness: 0.75 }],
  [/alu/i, { roughness: 0.42, metalness: 0.55 }],
  [/carbon/i, { roughness: 0.34, metalness: 0.25 }],
  [/rubber|tyre|tire/i, { roughness: 0.92, metalness: 0 }],
  [/glass/i, { roughness: 0.08, metalness: 0.1 }],
  [/wood|leaf|panel|wall|step/i, { roughness: 0.78, metalness: 0 }],
];
const PAINTED: Surface = { roughness: 0.5, metalness: 0.05 };

function surface_of(name: string): Surface {
  return SURFACES.find(([names]) => names.test(name))?.[1] ?? PAINTED;
}

// Gives all shapes under `root` their material.
export function paint_shapes(root: Object3D, look: Look): void {
  root.traverse((part) => {
    if (!(part instanceof Mesh)) return;
    part.castShadow = true;
    part.receiveShadow = true;
    const materials = [part.material].flat() as Material[];
    const painted = materials.map((material) => paint(material, look));
    part.material = Array.isArray(part.material) ? painted : painted[0]!;
  });
}

// One colour that shines through, behind what is at the same place, and without shadows.
export function paint_ghost(root: Object3D): void {
  root.traverse((part) => {
    if (part instanceof Mesh) part.material = GHOST;
  });
}

const GHOST = see_through(GHOST_COLOR, 0.32);
const REMOTE_TARGET = see_through(0xb4dd6f, 0.42);

// The same for where a remote machine is to be.
export function paint_target(root: Object3D): void {
  root.traverse((part) => {
    if (part instanceof Mesh) part.material = REMOTE_TARGET;
  });
}

function see_through(color: number, opacity: number): MeshStandardMaterial {
  return new MeshStandardMaterial({
    color,
    roughness: 0.7,
    transparent: true,
    opacity,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 4,
  });
}

function paint(material: Material, look: Look): Material {
  const own = "color" in material ? (material.color as Color) : new Color(current_theme().link);
  const color = own.clone().lerp(new Color(look.color), look.share);
  const opacity = look.opacity * material.opacity;
  return new MeshStandardMaterial({
    name: material.name,
    color,
    ...surface_of(material.name),
    opacity,
    transparent: opacity < 1,
  });
}

// Drawn over everything else: what must be seen inside solid parts.
export function glowing(color: number): MeshStandardMaterial {
  const material = new MeshStandardMaterial({ color, emissive: color, emissiveIntensity: 0.45 });
  material.depthTest = false;
  material.transparent = true; // drawn after the solid parts
  return material;
}
