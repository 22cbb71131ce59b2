// What of the run can be changed: its parts from lists, and a form field for each Setting of the
// scene; undo, reset and save.

import type { Commands, Refusal } from "../data/commands";
import type { Scene, Setting, Values } from "../messages";
import { download, make, make_button } from "../page";
import { UndoList, changed, changes_yaml } from "./changed_values";
import { ChoiceFields } from "./choices";
import { SettingField } from "./setting_field";

const UNLIMITED = "had no limit; start the run again (R) to put that back";
const PLAYED = "A recording is played: nothing of its run can be changed.";

const WHOLE = "Whole twin";
const REFERENCE = "Wrench at which it rests";
const SCALE = "How strongly the hand acts on it";

function heading_of({ group, name }: Setting): string {
  if (group !== "") return group;
  if (name.startsWith("felt_scale.")) return SCALE;
  return name.startsWith("reference_wrench.") ? REFERENCE : WHOLE;
}

// What people look for first: mass and weight, then the joints.
export function headings(settings: Setting[]): string[] {
  const last = [REFERENCE, SCALE];
  const place = (heading: string): number => (heading === WHOLE ? -1 : last.indexOf(heading) + 1);
  return [...new Set(settings.map(heading_of))].sort((a, b) => place(a) - place(b));
}

export class ChangePanel {
  private fields: SettingField[] = [];
  private scene: Scene | null = null;
  private readonly choices = new ChoiceFields((command, name) => this.commands.send(command, name));
  private values: (number | null)[] = []; // as the program said last
  private readonly steps = new UndoList();
  private readonly undo = make_button("Undo", "Takes the last change back", () => this.take_back());
  private readonly reset = make_button("Reset", "All values as in the files of the run", () =>
    this.put_back_all(),
  );
  private readonly save = make_button("Save YAML", "The changed values, for a scenario file", () =>
    this.save_yaml(),
  );

  constructor(
    private readonly section: HTMLElement,
    private readonly commands: Commands,
    private readonly report: (problem: string) => void,
  ) {}

  load(scene: Scene): void {
    this.scene = scene;
    this.steps.clear();
    this.values = scene.settings.map(({ value }) => value);
    this.section.replaceChildren();
    const refusal = scene.source === "recording" ? PLAYED : scene.refusal;
    if (refusal !== "") this.section.append(make("p", "quiet", refusal));
    this.section.append(...this.choices.load(scene));
    const can_set = scene.commands.includes("set");
    const set = (setting: Setting, value: number, before: number | null): void => {
      this.steps.note(setting.name, before, performance.now());
      this.commands.set(setting.name, value);
    };
    this.fields = scene.settings.map((setting) => new SettingField(setting, set, can_set));
    if (can_set && this.fields.length > 0) {
      this.section.append(make("div", "buttons", this.undo, this.reset, this.save));
    }
    this.show_tools();
    for (const heading of headings(scene.settings)) {
      const fields = this.fields.filter(({ setting }) => heading_of(setting) === heading);
      this.section.append(make("h2", "", heading), ...fields.map(({ part }) => part));
    }
  }

  take(values: Values): void {
    this.values = values.values;
    this.show_tools();
    for (const [i, field] of this.fields.entries()) field.take(values.values[i] ?? null);
  }

  // Puts back what was refused.
  refuse(refusal: Refusal): void {
    if (!this.scene) return;
    if (refusal.command === "set") {
      this.steps.refuse(refusal.name);
      this.show_tools();
      this.fields.find(({ setting }) => setting.name === refusal.name)?.refuse(refusal.reason);
      return;
    }
    this.choices.refuse(refusal);
  }

  private show_tools(): void {
    const has_changes = changed(this.scene?.settings ?? [], this.values).length > 0;
    this.undo.disabled = this.steps.is_empty;
    this.reset.disabled = this.save.disabled = !has_changes;
  }

  private take_back(): void {
    const step = this.steps.take();
    if (step) this.put_back(step.name, step.from);
    this.show_tools();
  }

  private put_back_all(): void {
    this.steps.clear();
    for (const { setting } of changed(this.scene?.settings ?? [], this.values)) {
      this.put_back(setting.name, setting.value);
    }
  }

  private put_back(name: string, value: number | null): void {
    if (value === null) this.report(`${name} ${UNLIMITED}`);
    else this.commands.set(name, value);
  }

  private save_yaml(): void {
    if (!this.scene) return;
    const { choices, settings } = this.scene;
    const text = changes_yaml(choices.scenario, settings, this.values);
    download(new Blob([text], { type: "application/yaml" }), "changes.yaml");
  }
}
