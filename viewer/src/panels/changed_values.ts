// Which values of the twin differ from those of the run's files, the way back, and their YAML. Pure
// functions and a list without a page.

import type { Setting } from "../messages";

export interface Step {
  name: string;
  from: number | null; // null: unlimited, which no command can set
}

interface SentStep extends Step {
  at_ms: number;
  sent: number; // values that were not refused
}

const SAME_MS = 1500; // a slider that is drawn is one step

// The steps that undo what was changed, the newest last.
export class UndoList {
  private steps: SentStep[] = [];
  private taken: SentStep | null = null; // whose value was sent back last

  get is_empty(): boolean {
    return this.steps.length === 0;
  }

  note(name: string, from: number | null, now_ms: number): void {
    const last = this.steps.at(-1);
    this.taken = null;
    if (last?.name === name && now_ms - last.at_ms < SAME_MS) {
      last.at_ms = now_ms;
      last.sent += 1;
    } else {
      this.steps.push({ name, from, at_ms: now_ms, sent: 1 });
    }
  }

  take(): Step | null {
    this.taken = this.steps.pop() ?? null;
    return this.taken;
  }

  // A value that was refused has changed nothing: the other values of its step are still there, and a
  // step that could not be taken back comes back.
  refuse(name: string): void {
    const last = this.steps.at(-1);
    if (this.taken?.name === name) {
      this.steps.push(this.taken);
      this.taken = null;
    } else if (last?.name === name) {
      last.sent -= 1;
      if (last.sent === 0) this.steps.pop();
    }
  }

  clear(): void {
    this.steps = [];
    this.taken = null;
  }
}

export interface Change {
  setting: Setting; // its value is that of the files
  value: number | null;
}

export function changed(settings: readonly Setting[], values: readonly (number | null)[]): Change[] {
  return settings.flatMap((setting, i) => {
    const value = values[i] ?? null;
    return value === setting.value ? [] : [{ setting, value }];
  });
}

// As entries of `changes` of a scenario file: they hold from its beginning.
export function changes_yaml(
  scenario: string,
  settings: readonly Setting[],
  values: readonly (number | null)[],
): string {
  const lines = [
    `# Values of the twin as changed in the page, in a run of ${scenario}.`,
    "# Put the list into a scenario file: docs/reference/configuration.md.",
    "changes:",
  ];
  const by_joint = new Map<string, string[]>();
  for (const { setting, value } of changed(settings, values)) {
    if (value === null) continue;
    const key = setting.name.slice(setting.group === "" ? 0 : setting.group.length + 1);
    if (setting.group === "" && key.includes(".")) continue; // wrenches follow
    const text = setting.name === "gravity" ? String(value !== 0) : number(value);
    by_joint.set(setting.group, [...(by_joint.get(setting.group) ?? []), `${key}: ${text}`]);
  }
  for (const [joint, entries] of by_joint) {
    const of_joint = joint === "" ? [] : [`joint: ${JSON.stringify(joint)}`];
    lines.push(`  - {${["at_s: 0", ...of_joint, ...entries].join(", ")}}`);
  }
  lines.push(...vectors_yaml(settings, values));
  return `${lines.join("\n")}\n`;
}

// Wrenches: a changed component needs its whole vector.
function vectors_yaml(settings: readonly Setting[], values: readonly (number | null)[]): string[] {
  const vectors = new Map<string, { all: string[]; is_changed: boolean }>();
  for (const [i, { name, group, value }] of settings.entries()) {
    if (group !== "" || !name.includes(".")) continue;
    const vector = name.slice(0, name.lastIndexOf("."));
    const { all, is_changed } = vectors.get(vector) ?? { all: [], is_changed: false };
    const present = values[i] ?? null;
    all.push(number(present ?? 0));
    vectors.set(vector, { all, is_changed: is_changed || present !== value });
  }
  return [...vectors].flatMap(([vector, { all, is_changed }]) => {
    const [group, key] = vector.split(".");
    return is_changed ? [`  - {at_s: 0, ${group}: {${key}: [${all.join(", ")}]}}`] : [];
  });
}

function number(value: number): string {
  return String(Number(value.toPrecision(9)));
}
