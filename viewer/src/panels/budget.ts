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

const SMALLEST_SHARE = 0.05; // of limits: below, something else is what one feels

// Whether limits carry a part of what the user pushes or turns with that can be felt.
export function limits_matter(budget: Budget): boolean {
  return (["force", "torque"] as const).some((kind) => {
    const parts = shares(budget, kind).filter(({ part }) => part === "limits" || part === "conflict");
    const value = parts.reduce((sum, part) => sum + part.value, 0);
    return value > SMALLEST_SHARE * total(budget, kind);
  });
}

// "mostly its mass (63 %) and damping (20 %)"; empty while there is nothing to explain.
export function summary(parts: Share[]): string {
  const sum = parts.reduce((all, { value }) => all + Math.max(0, value), 0);
  if (sum <= 0) return "";
  const large = parts
    .filter(({ value }) => value > 0.15 * sum)
    .sort((a, b) => b.value - a.value)
    .slice(0, 2)
    .map(({ part, value }) => ({ part, text: `${PARTS[part]} (${Math.round((100 * value) / sum)} %)` }));
  if (large.length === 0) return "";
  const why = large[0]!.part === "structure" ? ", you push where it cannot move" : "";
  return `mostly ${large.map(({ text }) => text).join(" and ")}${why}`;
}
