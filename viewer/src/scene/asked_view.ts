// The view that the address asks for: `view=NAME`, or `view=X,Y,Z:X,Y,Z`, an eye and the point that it
// looks at, m in B.

import { Vector3 } from "three";

import { page_options } from "../data/token";
import { VIEWS, type View } from "./cameras";
import type { Sight } from "./first_view";

const POINT = /^(-?[\d.]+),(-?[\d.]+),(-?[\d.]+)$/;

function point_of(text: string | undefined): Vector3 | null {
  const numbers = POINT.exec(text ?? "")?.slice(1).map(Number);
  return numbers?.every(Number.isFinite) ? new Vector3(numbers[0], numbers[1], numbers[2]) : null;
}

export function asked_view(text = page_options().get("view") ?? ""): View | Sight | null {
  const named = VIEWS.find((view) => view.replace(" ", "-") === text);
  if (named) return named;
  const [from, at, more] = text.split(":").map(point_of);
  return from && at && more === undefined ? { from, at } : null;
}

// As the address has it.
export function view_text({ from, at }: Sight): string {
  return [from, at].map((point) => point.toArray().map((x) => x.toFixed(3)).join(",")).join(":");
}
