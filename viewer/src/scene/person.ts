// A person who holds the handle with the right hand, for scale and to see through their eyes.

import {
  CapsuleGeometry,
  Group,
  Mesh,
  MeshStandardMaterial,
  type Object3D,
  Quaternion,
  SphereGeometry,
  TorusGeometry,
  Vector3,
} from "three";

import type { Theme } from "../theme";
import type { Eyes } from "./cameras";
import { elbow_between } from "./reach";
import { STAND_BACK, STAND_LEFT } from "./stance";

const UP = new Vector3(0, 1, 0); // axis of three's capsules
const SHOULDER = 1.42; // m, heights above the floor
const HIP = 0.92;
const EYES = 1.66;
const SHOULDER_OUT = 0.2; // m, from the middle
const UPPER_ARM = 0.31; // m
const FOREARM = 0.29; // m
const OPACITY = 0.62; // the device behind stays visible
const FOLLOW_SHARE = 0.12; // of the way per picture: one does not jump around the handle

class Limb {
  readonly mesh: Mesh;

  constructor(
    private readonly radius: number,
    private readonly length: number,
    material: MeshStandardMaterial,
  ) {
    this.mesh = new Mesh(new CapsuleGeometry(radius, length, 6, 16), material);
  }

  span(from: Vector3, to: Vector3): void {
    const along = new Vector3().subVectors(to, from);
    this.mesh.position.addVectors(from, to).multiplyScalar(0.5);
    this.mesh.scale.y = (along.length() + 2 * this.radius) / (this.length + 2 * this.radius);
    this.mesh.quaternion.setFromUnitVectors(UP, along.normalize());
  }
}

export class Person {
  readonly group = new Group();
  readonly eyes: Eyes = { p_B: new Vector3(), towards_B: new Vector3() };
  private readonly body = new Group(); // x to the right, y ahead, z up from the floor
  private readonly hand = new Group(); // frame of the handle: grip along x, user at z
  private readonly head: Mesh;
  private readonly right_arm: [Limb, Limb];
  private readonly left_arm: [Limb, Limb];
  private readonly legs: Limb[];
  private heading: number | null = null; // of the look, about z_B
  private readonly skin = new MeshStandardMaterial({ roughness: 0.8 });
  private readonly palm = new MeshStandardMaterial({ roughness: 0.8 }); // the hand never fades
  private readonly shirt = new MeshStandardMaterial({ roughness: 0.9 });

  // `faced_B`: what the person faces, beyond the handle; null: they stand where the hand axis points.
  constructor(
    private readonly floor_z_m: number,
    private readonly faced_B: Vector3 | null = null,
  ) {
    const { skin, shirt, palm } = this;
    for (const material of [skin, shirt, palm]) {
      Object.assign(material, { transparent: true, opacity: OPACITY });
    }
    const limb = (radius: number, length: number, material = skin): Limb => {
      const made = new Limb(radius, length, material);
      this.group.add(made.mesh);
      return made;
    };
    this.right_arm = [limb(0.05, UPPER_ARM, shirt), limb(0.038, FOREARM)];
    this.left_arm = [limb(0.05, UPPER_ARM, shirt), limb(0.038, FOREARM)];
    this.legs = [limb(0.075, HIP, shirt), limb(0.075, HIP, shirt)];
    const torso = new Mesh(new CapsuleGeometry(0.15, 0.32, 8, 24).rotateX(Math.PI / 2), shirt);
    torso.scale.set(1.2, 0.78, 1);
    torso.position.z = 1.17;
    this.head = new Mesh(new SphereGeometry(0.105, 28, 20), skin);
    this.head.scale.set(0.88, 1, 1.18);
    this.head.position.z = EYES;
    this.body.add(torso, this.head);
    this.build_hand(palm);
    this.group.add(this.body, this.hand);
    this.group.traverse((part) => (part.castShadow = part.receiveShadow = true));
  }

  paint(theme: Theme): void {
    this.skin.color.set(theme.person);
    this.palm.color.set(theme.person);
    this.shirt.color.set(theme.person).offsetHSL(0.0, 0.12, -0.14);
  }

  // Follows the handle at `p_B` with its attitude.
  pose(p_B: Vector3, attitude: Quaternion): void {
    const to_user = new Vector3(0, 0, 1).applyQuaternion(attitude);
    this.face(p_B, to_user);
    const heading = this.heading ?? 0;
    const ahead = new Vector3(Math.cos(heading), Math.sin(heading), 0);
    const right = new Vector3(ahead.y, -ahead.x, 0);
    const feet = p_B
      .clone()
      .addScaledVector(ahead, -STAND_BACK)
      .addScaledVector(right, -STAND_LEFT);
    feet.z = this.floor_z_m;
    this.body.position.copy(feet);
    this.body.rotation.z = heading - Math.PI / 2;
    const at = (x: number, y: number, z: number): Vector3 =>
      feet
        .clone()
        .addScaledVector(right, x)
        .addScaledVector(ahead, y)
        .setZ(this.floor_z_m + z);
    const wrist = p_B.clone().addScaledVector(to_user, 0.075);
    this.bend(this.right_arm, at(SHOULDER_OUT, 0, SHOULDER), wrist, at(0.9, -0.6, 0.4));
    this.bend(this.left_arm, at(-SHOULDER_OUT, 0, SHOULDER), at(-0.3, 0.07, 0.86), at(-1, -1, 1));
    this.legs[0]!.span(at(0.09, 0, HIP), at(0.11, 0.02, 0.06));
    this.legs[1]!.span(at(-0.09, 0, HIP), at(-0.11, -0.02, 0.06));
    this.hand.position.copy(p_B);
    this.hand.quaternion.copy(attitude);
    this.eyes.p_B.copy(at(0, -0.04, EYES));
    this.eyes.towards_B.copy(p_B);
  }

  // All of it but the hand that holds.
  get parts(): Object3D[] {
    return this.group.children.filter((part) => part !== this.hand);
  }

  // In first person one does not see one's own head and body, only hand and arm.
  hide_body(is_hidden: boolean): void {
    this.body.visible = !is_hidden;
    this.left_arm[0].mesh.visible = !is_hidden;
  }

  private face(p_B: Vector3, to_user: Vector3): void {
    const ahead = this.faced_B ? this.faced_B.clone().sub(p_B) : to_user.clone().negate();
    if (Math.hypot(ahead.x, ahead.y) < 0.2) return; // too steep to say
    this.turn_to(Math.atan2(ahead.y, ahead.x));
  }

  private turn_to(wanted: number): void {
    if (this.heading === null) this.heading = wanted;
    const turn = Math.atan2(Math.sin(wanted - this.heading), Math.cos(wanted - this.heading));
    this.heading += FOLLOW_SHARE * turn;
  }

  private bend(arm: [Limb, Limb], shoulder: Vector3, wrist: Vector3, towards: Vector3): void {
    const elbow = elbow_between(shoulder, wrist, UPPER_ARM, FOREARM, towards);
    arm[0].span(shoulder, elbow);
    arm[1].span(elbow, wrist);
  }

  // A fist around a bar along x.
  private build_hand(skin: MeshStandardMaterial): void {
    for (let i = 0; i < 4; i++) {
      const finger = new Mesh(new TorusGeometry(0.026, 0.011, 10, 20, 1.45 * Math.PI), skin);
      finger.rotation.set(0, Math.PI / 2, 0);
      finger.position.x = 0.03 - 0.021 * i;
      this.hand.add(finger);
    }
    const palm = new Mesh(new CapsuleGeometry(0.022, 0.05, 6, 16).rotateZ(Math.PI / 2), skin);
    palm.position.set(0, 0, 0.036);
    palm.scale.set(1, 1.2, 0.8);
    const thumb = new Mesh(new CapsuleGeometry(0.011, 0.04, 6, 12), skin);
    thumb.position.set(0.045, 0.02, 0.02);
    thumb.rotation.set(0.7, 0, -0.5);
    this.hand.add(palm, thumb);
  }
}
