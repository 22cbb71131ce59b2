// What the board in a headset says. Pure functions.

import { type Link } from "../data/freshness";
import { distance_text, nearest_limits, reason_text } from "../limit_words";
import type { Frame, Scene } from "../messages";
import { stop_text } from "../stop_button";
import { felt_text, mode_text } from "../text";

export interface BoardText {
  mode: string;
  kind: string; // of the mode, by which it is painted
  force: string;
  torque: string;
  limit: string; // the one that binds most, or comes next
  reason: string;
  stop: string; // empty: there is nothing to stop
  stop_note: string;
}

// The limit that is felt, another that acts, or the one that comes next.
function binding(scene: Scene, frame: Frame): [string, string] {
  const felt = frame.active.find(({ index }) => index === frame.felt?.index) ?? frame.active[0];
  if (felt) {
    const limit = scene.limits[felt.index]!;
    return [`limit ${limit.name}`, reason_text(limit, felt)];
  }
  const [next] = nearest_limits(scene, frame, 1);
  if (!next) return ["no limit is near", ""];
  const { name, unit } = scene.limits[next.index]!;
  return ["no limit acts", `next: ${name}, ${distance_text(next.distance, unit)} away`];
}

export function board_text(scene: Scene, frame: Frame, link: Link, page: number): BoardText {
  const { text: mode, kind } = mode_text(frame, link);
  const [limit, reason] = binding(scene, frame);
  const { text, note } = stop_text(link, frame.safety, page);
  const can_stop = scene.commands.includes("emergency_stop");
  return {
    mode,
    kind,
    force: `${Math.hypot(...frame.force_N).toFixed(0)} N`,
    torque: `${Math.hypot(...frame.torque_Nm).toFixed(1)} Nm`,
    limit,
    reason: reason || felt_text(scene, frame),
    stop: can_stop ? text : "",
    stop_note: note === "Esc" ? "point and pull the trigger, or touch" : note,
  };
}
