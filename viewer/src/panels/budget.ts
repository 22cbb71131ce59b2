// Where the user's force goes, part by part, along the direction in which the user pushes. The
// parts add up to the force. Pure functions.

import type { Budget, Vec3, Wrench } from "../messages";

export type Part = Exclude<keyof Budget, "user">;

export const PARTS: Record<Part, string> = {
  inertia: "mass of the twin",
  damping: "damping",
  spring: "springs, closers",
  friction: "friction",
  surface: "surfaces, reference",
  limits: "limits",
  conflict: "limits in conflict",
  structure: "bearings of the twin",
  rest: "rest",
};
export const PART_NAMES = Object.keys(PARTS) as Part[];

export type Kind = "force" | "torque";

interface Share {
  part: Part;
  value: number; // N or Nm along the user's force or torque
}

const SMALLEST = { force: 1, torque: 0.2 }; // N, Nm: below, there is nothing to explain

function of(wrench: Wrench, kind: Kind): Vec3 {
  return kind === "force" ? wrench.force_N : wrench.torque_Nm;
}

export function total(budget: Budget, kind: Kind): number {
  const size = Math.hypot(...of(budget.user, kind));
  return Number.isFinite(size) ? size : 0;
}

// All parts along the user's force or torque; zero while the user hardly pushes.
export function shares(budget: Budget, kind: Kind): Share[] {
  const user = of(budget.user, kind);
  const size = total(budget, kind);
  return PART_NAMES.map((part) => {
    const [x, y, z] = of(budget[part], kind);
    const along = (x * user[0] + y * user[1] + z * user[2]) / size;
    return { part, value: size >= SMALLEST[kind] && Number.isFinite(along) ? along : 0 };
  });
}

const HAND = 0.1; // m; a torque presses on the hand with the force that it makes at this distance
const SMALLEST_SHARE = 0.15; // of the whole: below, a cause is not named

// What a part adds to what the hand feels, forces and torques on one scale.
export interface Cause {
  part: Part;
  force_N: number; // along the user's wrench; all causes add up to its size
}

function size_of({ force_N, torque_Nm }: Wrench): number {
  return Math.hypot(...force_N, ...torque_Nm.map((torque) => torque / HAND));
}

function along(wrench: Wrench, user: Wrench): number {
  const product = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const both = product(wrench.force_N, user.force_N) + product(wrench.torque_Nm, user.torque_Nm) / HAND ** 2;
  return both / size_of(user);
}

// The causes of what the hand feels, the largest first; limits that contradict each other count as
// limits. Empty while the user hardly pushes or turns.
export function causes(budget: Budget): Cause[] {
  const is_felt = total(budget, "force") >= SMALLEST.force || total(budget, "torque") >= SMALLEST.torque;
  if (!is_felt || !Number.isFinite(size_of(budget.user))) return [];
  const all = PART_NAMES.filter((part) => part !== "conflict").map((part) => ({
    part,
    force_N:
      along(budget[part], budget.user) +
      (part === "limits" ? along(budget.conflict, budget.user) : 0),
  }));
  return all.filter(({ force_N }) => force_N > 0).sort((a, b) => b.force_N - a.force_N);
}

// Whether limits are among the causes that are named.
export function names_limits(found: Cause[]): boolean {
  return large(found).some(({ part }) => part === "limits");
}

function large(found: Cause[]): (Cause & { share: number })[] {
  const sum = found.reduce((all, { force_N }) => all + force_N, 0);
  return found
    .map((cause) => ({ ...cause, share: cause.force_N / sum }))
    .filter(({ share }) => share > SMALLEST_SHARE)
    .slice(0, 2);
}

// "mostly mass of the twin (63 %) and damping (20 %)"; empty while there is nothing to explain.
// `limit`: the limit that is felt, in words.
export function summary(found: Cause[], limit: string | null = null): string {
  const named = large(found);
  if (named.length === 0) return "";
  const texts = named.map(
    ({ part, share }) =>
      `${part === "limits" && limit ? limit : PARTS[part]} (${Math.round(100 * share)} %)`,
  );
  const why = named[0]!.part === "structure" ? ", you push where it cannot move" : "";
  return `mostly ${texts[0]}${why}${texts[1] ? `${why ? "; then" : " and"} ${texts[1]}` : ""}`;
}
