// What of the run can be changed: twin, law, person, and a form field for each Setting of the
// scene.

import type { Commands, Refusal } from "../data/commands";
import type { Choice, Scene, Setting, Values } from "../messages";
import { make } from "../page";
import { twin_text, unit_text } from "../text";
import { limited, number_text, place_of, value_at } from "./slider";

const CHOICES = [
  ["twin", "Twin", "twins"],
  ["law", "Law", "laws"],
  ["person", "Who holds the handle", "people"],
] as const;
const SLIDER_STEPS = 1000;
const PLAYED = "A recording is played: its twin, law and person cannot be changed.";

export function fill_choice(select: HTMLSelectElement, choices: Choice[], chosen: string): void {
  const options = choices.map(({ name, title }) => new Option(title, name));
  if (!choices.some(({ name }) => name === chosen)) options.unshift(new Option("as given", chosen));
  select.replaceChildren(...options);
  select.value = chosen;
}

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
  private fields: Field[] = [];
  private scene: Scene | null = null;

  constructor(
    private readonly section: HTMLElement,
    private readonly commands: Commands,
  ) {}

  load(scene: Scene): void {
    this.scene = scene;
    this.section.replaceChildren();
    const refusal = scene.source === "recording" ? PLAYED : scene.refusal;
    if (refusal !== "") this.section.append(make("p", "quiet", refusal));
    for (const [command, title, list] of CHOICES) {
      const choices = scene.choices[list];
      if (choices.length === 0 || !scene.commands.includes(command)) continue;
      const select = make("select");
      select.id = `choose-${command}`;
      fill_choice(select, choices, scene.choices[command]);
      if (command === "twin") select.selectedOptions[0]!.text = twin_text(scene);
      select.addEventListener("change", () => this.commands.send(command, select.value));
      this.section.append(make("label", "field", make("span", "", title), select));
    }
    const can_set = scene.commands.includes("set");
    this.fields = scene.settings.map((setting) => new Field(setting, this.commands, can_set));
    for (const heading of headings(scene.settings)) {
      const fields = this.fields.filter(({ setting }) => heading_of(setting) === heading);
      this.section.append(make("h2", "", heading), ...fields.map(({ part }) => part));
    }
  }

  take(values: Values): void {
    for (const [i, field] of this.fields.entries()) field.take(values.values[i] ?? null);
  }

  // Puts back what was refused.
  refuse(refusal: Refusal): void {
    if (!this.scene) return;
    if (refusal.command === "set") {
      this.fields.find(({ setting }) => setting.name === refusal.name)?.refuse(refusal.reason);
      return;
    }
    for (const [command] of CHOICES) {
      const select = document.getElementById(`choose-${command}`) as HTMLSelectElement | null;
      if (command === refusal.command && select) select.value = this.scene.choices[command];
    }
  }
}

class Field {
  readonly part: HTMLElement;
  private readonly slider = make("input");
  private readonly box = make("input");
  private readonly note = make("small", "problem");
  private value: number | null;

  constructor(
    readonly setting: Setting,
    private readonly commands: Commands,
    can_set: boolean,
  ) {
    this.slider.type = "range";
    this.slider.min = "0";
    this.slider.max = String(SLIDER_STEPS);
    this.slider.setAttribute("aria-label", setting.label);
    this.box.type = "text";
    this.box.inputMode = "decimal";
    this.box.placeholder = "unlimited";
    this.box.dataset.setting = setting.name;
    this.slider.disabled = this.box.disabled = !can_set;
    this.value = setting.value;
    const unit = make("span", "unit", unit_text(setting.unit));
    const head = make("label", "", make("span", "", setting.label), this.box, unit);
    this.part = make("div", "setting", head, this.slider, this.note);
    this.part.title = setting.help;
    this.note.hidden = true;
    this.slider.addEventListener("input", () => {
      this.send(value_at(Number(this.slider.value) / SLIDER_STEPS, setting));
    });
    this.box.addEventListener("change", () => this.read_box());
    this.part.addEventListener("focusout", () => this.show()); // what came meanwhile
    this.show();
  }

  take(value: number | null): void {
    this.value = value;
    const is_in_use = this.part.contains(document.activeElement);
    if (!is_in_use) this.show();
  }

  refuse(reason: string): void {
    this.note.textContent = reason;
    this.note.hidden = false;
    this.show();
  }

  private read_box(): void {
    const value = Number(this.box.value.trim().replace(",", "."));
    const { min, max } = this.setting;
    if (
      this.box.value.trim() === "" ||
      !Number.isFinite(value) ||
      value !== limited(value, this.setting)
    ) {
      this.refuse(`a number from ${number_text(min)} to ${number_text(max)} is expected`);
    } else {
      this.send(value);
    }
  }

  private send(value: number): void {
    this.note.hidden = true;
    this.value = value;
    this.commands.set(this.setting.name, value);
    this.show();
  }

  private show(): void {
    this.box.value = this.value === null ? "" : number_text(this.value);
    const place = this.value === null ? 1 : place_of(this.value, this.setting);
    this.slider.value = String(Math.round(SLIDER_STEPS * place));
  }
}
