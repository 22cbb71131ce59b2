// A board in the room of a headset: state, force, the limit that binds most, and STOP, which is pressed
// by a ray or a finger. It stands beside the wearer and does not move.

import {
  CanvasTexture,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  type Raycaster,
  SRGBColorSpace,
  Vector3,
} from "three";

import type { BoardText } from "./board_text";

const WIDTH_M = 0.56;
const HEIGHT_M = 0.42;
const PIXELS = { width: 1024, height: 768 };
const STOP_TOP = 0.62; // of the height: what is below is the button
const MARGIN = 28; // pixels
export const BOARD_ORDER = 10; // of drawing
const TOUCH_M = 0.012; // before the board: a finger presses
const AWAY_M = 0.035; // and may press again

const PLACE = new Vector3(-0.62, 1.2, -0.55); // m, in the headset's space: left of the wearer, ahead
const HEAD = new Vector3(0, 1.55, 0);

const INK = "#f4f7fa";
const QUIET = "#b4c2cf";
const GROUND = "#1b232c";
const STOP_RED = "#d3212c";
const MODES: Record<string, string> = {
  running: "#2fa36b",
  fault: "#e23d2d",
  unknown: "#8795a3",
  hold: "#e8a317",
};

export class Board {
  readonly mesh: Mesh<PlaneGeometry, MeshBasicMaterial>;
  private readonly canvas = document.createElement("canvas");
  private readonly texture: CanvasTexture;
  private shown = "";
  private is_touched = false;

  constructor(private readonly press: () => void) {
    Object.assign(this.canvas, PIXELS);
    this.texture = new CanvasTexture(this.canvas);
    this.texture.colorSpace = SRGBColorSpace;
    this.texture.anisotropy = 8;
    // nothing of the scene hides it or shines through; hands and controllers are drawn over it
    const material = new MeshBasicMaterial({ map: this.texture, toneMapped: false, fog: false });
    Object.assign(material, { transparent: true, depthTest: false, depthWrite: false });
    this.mesh = new Mesh(new PlaneGeometry(WIDTH_M, HEIGHT_M), material);
    this.mesh.renderOrder = BOARD_ORDER;
    this.mesh.position.copy(PLACE);
    this.mesh.up.set(0, 0, 1); // of B
    this.mesh.visible = false;
  }

  // Towards where the wearer's head is at first; its parent must have its place.
  face_wearer(): void {
    this.mesh.lookAt(this.mesh.parent!.localToWorld(HEAD.clone()));
  }

  show(text: BoardText): void {
    const key = JSON.stringify(text);
    if (key === this.shown) return;
    this.shown = key;
    this.paint(text);
    this.texture.needsUpdate = true;
  }

  // Whether a ray meets the board: then it takes hold of nothing else. `presses`: its trigger is pulled.
  meets(ray: Raycaster, presses: boolean): boolean {
    if (!this.mesh.visible) return false;
    const [hit] = ray.intersectObject(this.mesh, false);
    if (hit?.uv && presses && is_stop(hit.uv.x, hit.uv.y)) this.press();
    return hit !== undefined;
  }

  // A finger presses once when its tip, in B, comes to the button from before it.
  touch(tips: Vector3[]): void {
    const places = tips.map((tip) => this.mesh.worldToLocal(tip.clone()));
    const over = places.filter(({ x, y }) => is_stop(x / WIDTH_M + 0.5, y / HEIGHT_M + 0.5));
    const nearest = Math.min(Infinity, ...over.map(({ z }) => Math.abs(z)));
    if (nearest < TOUCH_M && !this.is_touched) this.press();
    if (nearest < TOUCH_M) this.is_touched = true;
    else if (nearest > AWAY_M) this.is_touched = false;
  }

  private paint(text: BoardText): void {
    const { width, height } = PIXELS;
    const pen = this.canvas.getContext("2d")!;
    pen.fillStyle = GROUND;
    pen.fillRect(0, 0, width, height);
    pen.textBaseline = "middle";
    const write = (words: string, x: number, y: number, size: number, color: string, bold = false): void => {
      pen.font = `${bold ? "bold " : ""}${size}px system-ui, sans-serif`;
      pen.fillStyle = color;
      pen.fillText(words, x, y, width - x - MARGIN); // narrower where it would not fit
    };
    pen.textAlign = "left";
    pen.fillStyle = MODES[text.kind] ?? QUIET;
    pen.fillRect(MARGIN, 34, 22, 62);
    write(text.mode, 74, 66, 64, INK, true);
    write(text.force, MARGIN, 186, 104, INK, true);
    write(text.torque, 420, 196, 64, QUIET);
    write(text.limit, MARGIN, 302, 54, INK);
    lines(text.reason, 46).forEach((line, i) => write(line, MARGIN, 366 + 50 * i, 40, QUIET));
    if (text.stop === "") return;
    const top = STOP_TOP * height;
    pen.fillStyle = STOP_RED;
    pen.fillRect(MARGIN, top, width - 2 * MARGIN, height - top - MARGIN);
    pen.textAlign = "center";
    write(text.stop, width / 2, top + 100, 110, "#ffffff", true);
    write(text.stop_note, width / 2, top + 200, 38, "#ffffff");
  }
}

function is_stop(u: number, v: number): boolean {
  return u >= 0 && u <= 1 && v >= 0 && v <= 1 - STOP_TOP;
}

// At most two lines of about `most` letters.
function lines(text: string, most: number): string[] {
  if (text.length <= most) return [text];
  const end = text.lastIndexOf(" ", most);
  return end < 0 ? [text] : [text.slice(0, end), text.slice(end + 1)];
}
