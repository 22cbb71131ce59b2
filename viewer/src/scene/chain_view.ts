// A chain on the stage: its URDF, placed in B and posed by coordinates.

import {
  type Object3D,
  BoxGeometry,
  Group,
  type LoadingManager,
  type Material,
  Mesh,
  MeshStandardMaterial,
  Quaternion,
  Vector3,
} from "three";
import { ColladaLoader } from "three/examples/jsm/loaders/ColladaLoader.js";
import { STLLoader } from "three/examples/jsm/loaders/STLLoader.js";
import URDFLoader, { type URDFJoint, type URDFRobot } from "urdf-loader";

import { authorization } from "../data/token";
import type { SceneChain, SceneJoint, TwinBase } from "../messages";
import { current_theme } from "../theme";
import { position_of } from "./follower";
import { put_at_root } from "./root";
import { add_skeleton, has_shapes } from "./skeleton";

const MESHES = "/models/"; // where the program puts mesh files

type Paint = (root: Object3D) => void; // gives all shapes their material

interface Rest {
  position: Vector3;
  quaternion: Quaternion;
}

export class ChainView {
  readonly placement = new Group();
  readonly complete: Promise<unknown>; // when its mesh files are there, or missing for good
  private readonly robot: URDFRobot | null;
  private readonly rests = new Map<Object3D, Rest>();

  constructor(
    private readonly chain: SceneChain,
    urdf: string,
    paint: Paint,
  ) {
    const meshes: Promise<void>[] = [];
    this.robot = urdf === "" ? null : parse(urdf, paint, meshes);
    this.complete = Promise.all(meshes);
    put_at_root(this.placement, chain);
    this.placement.add(this.robot ?? plain_body());
    const is_shown = has_shapes(this.robot) || urdf.includes(`filename="${MESHES}`);
    if (this.robot && !is_shown) add_skeleton(this.robot, current_theme().link);
    paint(this.placement);
    for (const joint of Object.values(this.robot?.joints ?? {})) joint.ignoreLimits = true;
  }

  joint(name: string): URDFJoint | null {
    return this.robot?.joints[name] ?? null;
  }

  link(name: string): Object3D | null {
    return this.robot?.links[name] ?? null;
  }

  // `q` holds the coordinates of all joints in the order of the scene; `base`: where the root link is
  // now, null = at its placement.
  pose(q: number[], base: TwinBase | null = null): void {
    put_at_root(this.placement, this.chain, base);
    let first = 0;
    for (const [index, joint] of this.chain.joints.entries()) {
      if (joint.type === "floating") {
        this.pose_floating(joint.name, q.slice(first, first + 7));
        first += 7;
      } else if (joint.planar !== "") {
        const is_first = this.chain.joints[index - 1]?.planar !== joint.planar;
        if (is_first) this.pose_planar(this.chain.joints.slice(index, index + 3), q.slice(first));
        first += 1;
      } else {
        this.robot?.setJointValue(joint.name, q[first] ?? 0);
        this.pose_followers(joint.name, q[first] ?? 0);
        first += 1;
      }
    }
  }

  // Joints that follow this one by curves.
  private pose_followers(leader: string, q: number): void {
    for (const follower of this.chain.followers) {
      if (follower.leader === leader)
        this.robot?.setJointValue(follower.joint, position_of(follower, q));
    }
  }

  // The urdf library describes floating joints by angles; here they come as x y z qx qy qz qw.
  private pose_floating(name: string, q: number[]): void {
    const [x, y, z, qx, qy, qz, qw] = q as [number, number, number, number, number, number, number];
    const part = this.robot?.joints[name] ?? this.placement.children[0]!;
    this.move(part, new Vector3(x, y, z), new Quaternion(qx, qy, qz, qw).normalize());
  }

  // The urdf library slides planar joints along axes of the parent; here their axes come along.
  private pose_planar(parts: SceneJoint[], q: number[]): void {
    const part = this.robot?.joints[parts[0]!.planar];
    if (!part) return;
    const shift = new Vector3();
    const turn = new Quaternion();
    for (const [i, { type, axis }] of parts.entries()) {
      if (type === "prismatic") shift.addScaledVector(new Vector3(...axis), q[i] ?? 0);
      else turn.setFromAxisAngle(new Vector3(...axis), q[i] ?? 0);
    }
    this.move(part, shift, turn);
  }

  // Moves a part by `shift` and `turn` from where it is when its coordinates are zero.
  private move(part: Object3D, shift: Vector3, turn: Quaternion): void {
    const rest = this.rest(part);
    part.position.copy(shift).applyQuaternion(rest.quaternion).add(rest.position);
    part.quaternion.multiplyQuaternions(rest.quaternion, turn);
  }

  // Where a part is when its coordinates are zero.
  private rest(part: Object3D): Rest {
    const known = this.rests.get(part);
    if (known) return known;
    const rest = { position: part.position.clone(), quaternion: part.quaternion.clone() };
    this.rests.set(part, rest);
    return rest;
  }
}

export async function load_chain(chain: SceneChain, paint: Paint): Promise<ChainView> {
  if (chain.urdf === "") return new ChainView(chain, "", paint);
  const response = await fetch(chain.urdf, { headers: authorization() });
  if (!response.ok) throw new Error(`${chain.urdf}: ${response.statusText}`);
  return new ChainView(chain, await response.text(), paint);
}

// As the urdf library does it, with the token.
async function load_mesh(
  address: string,
  manager: LoadingManager,
  material: Material,
): Promise<Object3D> {
  if (/\.stl$/i.test(address)) {
    const loader = new STLLoader(manager).setRequestHeader(authorization());
    return new Mesh(await loader.loadAsync(address), material);
  }
  const loader = new ColladaLoader(manager).setRequestHeader(authorization());
  return (await loader.loadAsync(address))!.scene;
}

// Mesh files arrive later; those that the program has not found stay away.
function parse(urdf: string, paint: Paint, meshes: Promise<void>[]): URDFRobot {
  const loader = new URDFLoader();
  loader.loadMeshCb = (address, manager, material, done) => {
    if (!address.startsWith(MESHES)) return;
    const arrived = load_mesh(address, manager, material).then(
      (mesh) => {
        paint(mesh);
        done(mesh);
      },
      (error) => done(null as unknown as Object3D, error),
    );
    meshes.push(arrived);
  };
  return loader.parse(urdf);
}

function plain_body(): Group {
  const body = new Group();
  const material = new MeshStandardMaterial({ color: 0x4a90a4 });
  body.add(new Mesh(new BoxGeometry(0.14, 0.14, 0.14), material));
  return body;
}
