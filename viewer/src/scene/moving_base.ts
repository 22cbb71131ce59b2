// The place where a twin stands, when it moves: a deck with the axes of the root link, the way that
// the root link has gone, and a thin outline of where the deck rests.

import { BoxGeometry, BufferGeometry, Group, LineDashedMaterial, LineLoop, Mesh, MeshStandardMaterial, Vector3 } from "three";

import type { SceneChain, TwinBase } from "../messages";
import { BASE_COLOR, type Theme } from "../theme";
import { put_at_root } from "./root";
import { Trail } from "./trail";

const DECK = { long: 2.2, wide: 1.8, plank: 0.18, gap: 0.02, thick: 0.02, rim: 0.05 }; // m
const AXIS = { long: 0.3, thick: 0.012 }; // m
const AXES = [
  [1, 0, 0, 0xd0453c],
  [0, 1, 0, 0x3d9140],
  [0, 0, 1, 0x3a6fd0],
] as const;

export class MovingBaseView {
  readonly group = new Group();
  private readonly carried = new Group(); // at the root link
  private readonly trail = new Trail(BASE_COLOR);
  private readonly outline: LineDashedMaterial;

  constructor(
    private readonly chain: SceneChain,
    floor_z_m: number,
  ) {
    put_at_root(this.carried, chain);
    const deck = deck_of();
    const [x, y] = chain.p_B_root_m;
    deck.position.set(x, y, floor_z_m);
    this.carried.updateMatrixWorld(true);
    this.carried.attach(deck);
    this.carried.add(...axes());
    this.outline = new LineDashedMaterial({ dashSize: 0.06, gapSize: 0.05 });
    const rest = outline_of(this.outline);
    rest.position.set(x, y, floor_z_m + 0.004);
    this.group.add(this.carried, rest, this.trail.line);
  }

  note(base: TwinBase | null): void {
    if (base) this.trail.add(base.p_B_m);
  }

  forget_way(): void {
    this.trail.clear();
  }

  show(base: TwinBase | null): void {
    put_at_root(this.carried, this.chain, base);
  }

  paint(theme: Theme): void {
    this.outline.color.set(theme.box);
  }
}

// Planks along x in a rim; its upper side is at z = 0.
function deck_of(): Group {
  const { long, wide, plank, gap, thick, rim } = DECK;
  const deck = new Group();
  const wood = new MeshStandardMaterial({ color: 0xb99a6b, roughness: 0.85, transparent: true, opacity: 0.5 });
  wood.depthWrite = false;
  const painted = new MeshStandardMaterial({ color: BASE_COLOR, roughness: 0.6 });
  const count = Math.round(wide / plank);
  for (let i = 0; i < count; i++) {
    add(deck, new Mesh(new BoxGeometry(long, plank - gap, thick), wood), 0, (i - 0.5 * (count - 1)) * plank, -0.5 * thick);
  }
  for (const side of [-1, 1]) {
    const along = new BoxGeometry(long + 2 * rim, rim, rim);
    add(deck, new Mesh(along, painted), 0, 0.5 * side * (wide + rim), -0.5 * rim);
    add(deck, new Mesh(new BoxGeometry(rim, wide, rim), painted), 0.5 * side * (long + rim), 0, -0.5 * rim);
  }
  return deck;
}

function axes(): Mesh[] {
  return AXES.map(([x, y, z, color]) => {
    const size = [x, y, z].map((part) => (part === 1 ? AXIS.long : AXIS.thick)) as [number, number, number];
    const bar = new Mesh(new BoxGeometry(...size), new MeshStandardMaterial({ color, roughness: 0.5 }));
    bar.position.set(x, y, z).multiplyScalar(0.5 * AXIS.long);
    return bar;
  });
}

// Where the deck rests, seen from above.
function outline_of(material: LineDashedMaterial): LineLoop {
  const [x, y] = [0.5 * DECK.long + DECK.rim, 0.5 * DECK.wide + DECK.rim];
  const corners = [[x, y], [-x, y], [-x, -y], [x, -y]].map(([a, b]) => new Vector3(a, b, 0));
  const line = new LineLoop(new BufferGeometry().setFromPoints(corners), material);
  line.computeLineDistances();
  return line;
}

function add(group: Group, part: Mesh, x: number, y: number, z: number): void {
  part.position.set(x, y, z);
  part.receiveShadow = true;
  group.add(part);
}
