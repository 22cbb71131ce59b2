// "Why do I feel this?": the force, the limits that act, those that come next, the closed budget,
// and the safety state with its cause.

import { base_text } from "../base_text";
import {
  distance_text,
  is_near,
  kind_text,
  nearest_limits,
  reaction_text,
  reason_text,
} from "../limit_words";
import type { ActiveLimit, Frame, Scene } from "../messages";
import { fill, make, make_button, write } from "../page";
import { felt_contact, felt_text, is_pushing } from "../text";
import { type Kind, PARTS, PART_NAMES, type Part, causes, shares, total } from "./budget";

const FULL_FORCE = 80; // N, of a full bar
const FULL_TORQUE = 10; // Nm
const MOST_NEAR = 3;
const SMALLEST_SCALE = { force: 15, torque: 2 }; // N, Nm: half the width of a budget bar
const WORST_MEASURE = 0.15; // of the singularity: below it the bar is red

interface BudgetRow {
  row: HTMLElement;
  bar: HTMLElement;
  value: HTMLElement;
}

export class FeelPanel {
  private readonly force = make("output", "large");
  private readonly torque = make("output", "large");
  private readonly force_bar = make("div", "bar force", make("i"));
  private readonly torque_bar = make("div", "bar torque", make("i"));
  private readonly reason = make("p", "reason");
  private readonly base = make("p", "quiet");
  private readonly acting = make("ul", "limits");
  private readonly near = make("ul", "limits near");
  private readonly singularity = make("div", "bar", make("i"));
  private readonly singularity_text = make("output");
  private readonly singularity_part: HTMLElement;
  private readonly sum = make("p", "sum");
  private readonly safety = make("p", "safety");
  private readonly rows = new Map<Part, BudgetRow>();
  private readonly kind_button: HTMLButtonElement;
  private kind: Kind = "force";
  private scale = SMALLEST_SCALE.force;

  constructor(section: HTMLElement) {
    this.base.id = "twin-base";
    this.kind_button = make_button("N", "Forces or torques", () => {
      this.kind = this.kind === "force" ? "torque" : "force";
      this.scale = SMALLEST_SCALE[this.kind];
    });
    this.kind_button.className = "small";
    this.singularity_part = make(
      "div",
      "joint",
      make("span", "", "the singularity"),
      this.singularity_text,
      this.singularity,
    );
    const budget = make("div", "budget");
    for (const part of PART_NAMES) budget.append(this.add_row(part));
    const wrench = make("div", "wrench", this.one("force", this.force, "N", this.force_bar));
    wrench.append(this.one("torque", this.torque, "Nm", this.torque_bar));
    const body = make(
      "div",
      "feel-body",
      wrench,
      make("h2", "", "Why do I feel this?"),
      this.reason,
      this.base,
      this.acting,
      make("h2", "with-button", "Where it goes", this.kind_button),
      budget,
      this.sum,
      make("h2", "", "What comes next"),
      this.near,
      this.singularity_part,
      make("h2", "", "Safety"),
      this.safety,
    );
    section.append(body);
  }

  show(scene: Scene, frame: Frame): void {
    const force = Math.hypot(...frame.force_N);
    const torque = Math.hypot(...frame.torque_Nm);
    write(this.force, force.toFixed(force < 9.95 ? 1 : 0));
    write(this.torque, torque.toFixed(torque < 9.95 ? 1 : 0));
    fill(this.force_bar, force / FULL_FORCE);
    fill(this.torque_bar, torque / FULL_TORQUE);
    write(this.reason, felt_text(scene, frame));
    const first = causes(frame.budget)[0]?.part;
    const is_held = first === "limits" || (first === "surface" && felt_contact(frame) !== null);
    this.reason.dataset.held = String(is_held && is_pushing(frame));
    const base = base_text(scene, frame.twin_base);
    write(this.base, base);
    this.base.hidden = base === "";
    this.show_acting(scene, frame);
    this.show_near(scene, frame);
    this.show_singularity(scene, frame);
    this.show_budget(frame);
    write(this.safety, frame.fault === "" ? frame.mode_text : `${frame.mode_text}: ${frame.fault}`);
    this.safety.dataset.mode = frame.mode;
  }

  private one(name: string, value: HTMLElement, unit: string, bar: HTMLElement): HTMLElement {
    return make("div", name, make("p", "", value, ` ${unit}`), bar, make("small", "", name));
  }

  private show_acting(scene: Scene, frame: Frame): void {
    const felt_first = (active: ActiveLimit): number => Number(active.index !== frame.felt?.index);
    const lines = [...frame.active]
      .sort((a, b) => felt_first(a) - felt_first(b))
      .map((active) => acting_line(scene, frame, active));
    update_list(this.acting, lines);
  }

  private show_near(scene: Scene, frame: Frame): void {
    const lines = nearest_limits(scene, frame, MOST_NEAR).map(({ index, distance }) => {
      const limit = scene.limits[index]!;
      return {
        title: limit.name,
        value: `${distance_text(distance, limit.unit)} away`,
        detail: kind_text(limit.kind),
        state: is_near(distance, limit.unit) ? "near" : "far",
      };
    });
    update_list(this.near, lines);
  }

  private show_singularity(scene: Scene, frame: Frame): void {
    this.singularity_part.hidden = frame.singularity === null;
    if (!frame.singularity) return;
    const { measure, limit } = frame.singularity;
    fill(this.singularity, measure);
    this.singularity.dataset.state = measure < WORST_MEASURE ? "active" : "far";
    write(this.singularity_text, `${Math.round(100 * measure)} % away`);
    const guard = limit >= 0 ? `${scene.limits[limit]!.name} keeps away from it` : "";
    if (this.singularity_part.title !== guard) this.singularity_part.title = guard;
  }

  private show_budget(frame: Frame): void {
    const { kind } = this;
    const unit = kind === "force" ? "N" : "Nm";
    const parts = shares(frame.budget, kind);
    const largest = Math.max(...parts.map(({ value }) => Math.abs(value)), SMALLEST_SCALE[kind]);
    this.scale = largest > this.scale ? largest : 0.94 * this.scale + 0.06 * largest;
    for (const { part, value } of parts) {
      const { row, bar, value: text } = this.rows.get(part)!;
      const share = Math.min(1, Math.abs(value) / this.scale);
      bar.style.transform = `scaleX(${(value < 0 ? -share : share).toFixed(3)})`;
      write(text, Math.abs(value) < 0.05 ? "0" : value.toFixed(1));
      row.dataset.small = String(Math.abs(value) < 0.05);
    }
    const whole = total(frame.budget, kind);
    write(
      this.sum,
      `together ${whole.toFixed(1)} ${unit}, what you ${kind === "force" ? "push" : "turn"} with`,
    );
    write(this.kind_button, unit);
  }

  private add_row(part: Part): HTMLElement {
    const bar = make("i");
    const value = make("output");
    const row = make("div", "part", make("span", "", PARTS[part]), make("div", "both", bar), value);
    row.dataset.part = part;
    this.rows.set(part, { row, bar, value });
    return row;
  }
}

interface Line {
  title: string;
  value: string;
  detail: string;
  state: string;
}

function acting_line(scene: Scene, frame: Frame, active: ActiveLimit): Line {
  const limit = scene.limits[active.index]!;
  const side = active.state === "lower" || active.state === "upper" ? `, ${active.state}` : "";
  const distance = frame.limit_distance[active.index];
  const left = distance ? ` \u00b7 ${distance_text(distance, limit.unit)} to its end` : "";
  return {
    title: `${limit.name}${side}`,
    value: reaction_text(active.reaction, limit.unit),
    detail: `${reason_text(limit, active)} \u00b7 priority ${limit.priority}${left}`,
    state: active.index === frame.felt?.index ? "felt" : "active",
  };
}

// Keeps the elements of lines that stay, so that nothing flickers.
function update_list(list: HTMLElement, lines: Line[]): void {
  while (list.children.length > lines.length) list.lastElementChild!.remove();
  for (const [i, line] of lines.entries()) {
    let item = list.children[i] as HTMLElement | undefined;
    if (!item) {
      item = make("li", "", make("b"), make("output"), make("small"));
      list.append(item);
    }
    item.dataset.state = line.state;
    write(item.children[0] as HTMLElement, line.title);
    write(item.children[1] as HTMLElement, line.value);
    write(item.children[2] as HTMLElement, line.detail);
  }
}
