// Where the device stands in a real room: a ring on the floor where a controller, or a hand, points.

import { Mesh, MeshBasicMaterial, RingGeometry, type Vector3, type WebGLRenderer } from "three";

import { TARGET_COLOR } from "../theme";

export class Placement {
  readonly ring: Mesh;
  private sources: XRHitTestSource[] = [];
  private inputs: readonly XRInputSource[] = [];

  constructor(private readonly renderer: WebGLRenderer) {
    const shape = new RingGeometry(0.11, 0.14, 48).rotateX(-Math.PI / 2);
    this.ring = new Mesh(shape, new MeshBasicMaterial({ color: TARGET_COLOR, toneMapped: false }));
    this.ring.visible = false;
  }

  // In the headset's space; null: nothing that is pointed at is known.
  get place(): Vector3 | null {
    return this.ring.visible ? this.ring.position : null;
  }

  get is_active(): boolean {
    return this.sources.length > 0;
  }

  // False where the headset knows no surfaces of the room.
  async begin(session: XRSession): Promise<boolean> {
    this.end();
    this.inputs = [...session.inputSources];
    const ask = (input: XRInputSource): Promise<XRHitTestSource | undefined> | undefined =>
      session.requestHitTestSource?.({ space: input.targetRaySpace });
    const asked = await Promise.allSettled(this.inputs.map(ask));
    this.sources = asked.flatMap((one) => (one.status === "fulfilled" && one.value ? [one.value] : []));
    return this.is_active;
  }

  // Before each picture: moves the ring to the nearest surface.
  update(): void {
    const frame = this.renderer.xr.getFrame();
    const space = this.renderer.xr.getReferenceSpace();
    if (!this.is_active || !frame || !space) return;
    const poses = this.sources.map((source) => frame.getHitTestResults(source)[0]?.getPose(space));
    const pose = poses.find((found) => found);
    this.ring.visible = pose !== undefined;
    if (pose) this.ring.position.copy(pose.transform.position as unknown as Vector3);
  }

  end(): void {
    for (const source of this.sources) source.cancel();
    this.sources = [];
    this.ring.visible = false;
  }
}
