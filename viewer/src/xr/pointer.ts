// A controller or a hand of a headset, as it is seen: from shapes of our own, nothing is fetched.

import {
  BufferGeometry,
  CapsuleGeometry,
  CylinderGeometry,
  Group,
  InstancedMesh,
  Line,
  LineBasicMaterial,
  type Material,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  type Object3D,
  Quaternion,
  Raycaster,
  SphereGeometry,
  TorusGeometry,
  Vector3,
  type WebXRManager,
  type XRHandSpace,
  type XRTargetRaySpace,
} from "three";
import type { XRHandModel } from "three/examples/jsm/webxr/XRHandModelFactory.js";
import { XRHandPrimitiveModel } from "three/examples/jsm/webxr/XRHandPrimitiveModel.js";

import { TARGET_COLOR } from "../theme";
import { BOARD_ORDER } from "./board";

const RAY_M = 1.2; // of the line that shows where it points
const SKIN = 0xd9b08c;
const AHEAD = new Vector3(0, 0, 1);
const FINGERS = ["thumb", "index-finger", "middle-finger", "ring-finger", "pinky-finger"];
const SHELL = 0x2c343d;

// Both ends of each finger's parts, and of the palm's.
const BONES: [XRHandJoint, XRHandJoint][] = FINGERS.flatMap((finger) => {
  const middle = finger === "thumb" ? [] : [`${finger}-phalanx-intermediate`];
  const chain = ["wrist", `${finger}-metacarpal`, `${finger}-phalanx-proximal`, ...middle];
  chain.push(`${finger}-phalanx-distal`, `${finger}-tip`);
  return chain.slice(1).map((joint, i): [XRHandJoint, XRHandJoint] => [
    chain[i] as XRHandJoint,
    joint as XRHandJoint,
  ]);
});

export class Pointer {
  readonly ray: XRTargetRaySpace; // its select event is a trigger, or a pinch of a hand
  readonly caster = new Raycaster();
  private readonly hand: XRHandSpace;
  private readonly model = controller_model();
  private readonly fingers: XRHandPrimitiveModel;
  private readonly spheres: InstancedMesh<BufferGeometry, MeshStandardMaterial>;
  private readonly line: Line<BufferGeometry, LineBasicMaterial>;
  private readonly bones = new InstancedMesh(
    new CylinderGeometry(1, 1, 1, 12).rotateX(Math.PI / 2),
    new MeshStandardMaterial({ color: SKIN }),
    BONES.length,
  );
  private has_hand = false;

  constructor(xr: WebXRManager, index: number, rig: Object3D) {
    this.ray = xr.getController(index);
    this.hand = xr.getHand(index);
    const grip = xr.getControllerGrip(index);
    // its types ask for the model of a factory, of which it uses only add()
    const parent = this.hand as unknown as XRHandModel;
    this.fingers = new XRHandPrimitiveModel(parent, this.hand, "", "right", { primitive: "sphere" });
    this.spheres = this.fingers.handMesh as unknown as InstancedMesh<BufferGeometry, MeshStandardMaterial>;
    this.spheres.material.color.set(SKIN);
    grip.add(this.model);
    const ends = new BufferGeometry().setFromPoints([new Vector3(), new Vector3(0, 0, -RAY_M)]);
    this.line = new Line(ends, new LineBasicMaterial({ color: TARGET_COLOR, transparent: true, opacity: 0.6 }));
    this.bones.frustumCulled = false;
    this.ray.add(this.line);
    this.hand.add(this.bones);
    for (const part of [this.model, this.hand, this.line]) draw_over_board(part);
    for (const space of [this.ray, grip, this.hand]) {
      space.visible = false; // until three finds it
      rig.add(space);
    }
    this.ray.addEventListener("connected", ({ data }) => (this.has_hand = data.hand != null));
  }

  get is_seen(): boolean {
    return this.ray.visible;
  }

  private pose_bones(): void {
    const ends = BONES.map((names) => names.map((name) => this.hand.joints[name]));
    for (const [i, [from, to]] of ends.entries()) {
      if (!from || !to) continue;
      const along = to.position.clone().sub(from.position);
      const radius = 0.8 * Math.min(from.jointRadius ?? 0.008, to.jointRadius ?? 0.008);
      const turn = new Quaternion().setFromUnitVectors(AHEAD, along.clone().normalize());
      const middle = from.position.clone().addScaledVector(along, 0.5);
      const size = new Vector3(radius, radius, along.length());
      this.bones.setMatrixAt(i, new Matrix4().compose(middle, turn, size));
    }
    this.bones.instanceMatrix.needsUpdate = true;
  }

  // Where the tip of the index finger is, in B; null: there is no hand.
  get fingertip(): Vector3 | null {
    const tip = this.hand.joints["index-finger-tip"];
    return this.has_hand && tip?.visible ? tip.getWorldPosition(new Vector3()) : null;
  }

  // Before each picture.
  update(): void {
    this.model.visible = !this.has_hand;
    this.spheres.visible = this.bones.visible = this.has_hand;
    if (this.has_hand && this.hand.joints["wrist"]) {
      this.fingers.updateMesh();
      this.pose_bones();
    }
    this.ray.updateWorldMatrix(true, false);
    this.caster.ray.origin.setFromMatrixPosition(this.ray.matrixWorld);
    this.caster.ray.direction.set(0, 0, -1).transformDirection(this.ray.matrixWorld);
  }
}

function draw_over_board(part: Object3D): void {
  part.traverse((mesh) => {
    if (!(mesh instanceof Mesh || mesh instanceof Line)) return;
    (mesh.material as Material).transparent = true; // drawn after what is solid, as the board is
    mesh.renderOrder = BOARD_ORDER + 1;
  });
}

// A stick along z with a head, its trigger in front and a thumb stick: the space of a grip.
function controller_model(): Group {
  const model = new Group();
  const shell = new MeshStandardMaterial({ color: SHELL, roughness: 0.6 });
  const accent = new MeshStandardMaterial({ color: TARGET_COLOR, roughness: 0.5 });
  const add = (shape: BufferGeometry, material: MeshStandardMaterial, x: number, y: number, z: number): void => {
    const mesh = new Mesh(shape, material);
    mesh.position.set(x, y, z);
    model.add(mesh);
  };
  add(new CapsuleGeometry(0.017, 0.075, 6, 20).rotateX(Math.PI / 2), shell, 0, 0, 0.025);
  add(new CylinderGeometry(0.027, 0.022, 0.02, 28).rotateX(0.25), shell, 0, 0.012, -0.038);
  add(new TorusGeometry(0.027, 0.0035, 10, 32).rotateX(Math.PI / 2 + 0.25), accent, 0, 0.022, -0.04);
  add(new SphereGeometry(0.0085, 16, 12), accent, 0, 0.03, -0.043);
  add(new CapsuleGeometry(0.006, 0.016, 4, 12).rotateX(0.5), accent, 0, -0.014, -0.045);
  return model;
}
