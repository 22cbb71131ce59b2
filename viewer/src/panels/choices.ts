// The parts of a run that can be chosen from lists: each choice begins another run. A refused one is
// put back, and the reason stays below it until the next.

import type { CommandName, Refusal } from "../data/commands";
import type { Choice, Scene } from "../messages";
import { make } from "../page";
import { device_text, surfaces_text, twin_text, with_capital } from "../text";

type Part = "twin" | "device" | "surfaces" | "law" | "person";

const CHOICES = [
  ["twin", "Twin", "twins", twin_text],
  ["device", "Device", "devices", device_text],
  ["surfaces", "Virtual surfaces", "surface_sets", surfaces_text],
  ["law", "Law", "laws", null],
  ["person", "Who holds the handle", "people", null],
] as const;

function option_of({ title, name }: Choice): HTMLOptionElement {
  return new Option(title, name);
}

// Choices with a heading stand below it, in the order of the list.
export function fill_choice(select: HTMLSelectElement, choices: Choice[], chosen: string): void {
  const parts: HTMLElement[] = [];
  if (!choices.some(({ name }) => name === chosen)) parts.push(new Option("as given", chosen));
  for (const [i, choice] of choices.entries()) {
    const is_same = i > 0 && choices[i - 1]!.group === choice.group;
    if (choice.group === "") {
      parts.push(option_of(choice));
    } else if (is_same) {
      parts.at(-1)!.append(option_of(choice));
    } else {
      const group = make("optgroup", "", option_of(choice));
      group.label = choice.group;
      parts.push(group);
    }
  }
  select.replaceChildren(...parts);
  select.value = chosen;
}

// "Device not changed: ..."; other refusals by the name of their command.
export function refusal_text({ command, reason }: Refusal): string {
  const chosen = CHOICES.find(([part]) => part === command);
  if (!chosen) return `${command}: ${reason}`;
  return `${chosen[1]} not changed: ${reason}.`;
}

export class ChoiceFields {
  private readonly fields = new Map<string, { select: HTMLSelectElement; problem: HTMLElement }>();
  private scene: Scene | null = null;

  constructor(private readonly send: (command: CommandName, name: string) => void) {}

  // The fields of what `scene` lets one choose.
  load(scene: Scene): HTMLElement[] {
    this.scene = scene;
    this.fields.clear();
    const made: HTMLElement[] = [];
    for (const [part, title, list, words] of CHOICES) {
      const choices = scene.choices[list];
      if (choices.length === 0 || !scene.commands.includes(part)) continue;
      const text = words ? words(scene) : "";
      made.push(this.add(part, title, choices, text));
    }
    return made;
  }

  refuse({ command, reason }: Refusal): void {
    const field = this.fields.get(command);
    if (!field || !this.scene) return;
    field.select.value = this.scene.choices[command as Part];
    field.problem.textContent = `${with_capital(reason)}.`;
    field.problem.hidden = false;
  }

  private add(part: Part, title: string, choices: Choice[], text: string): HTMLElement {
    const select = make("select");
    const problem = make("span", "problem");
    select.id = `choose-${part}`;
    problem.id = `${select.id}-problem`;
    problem.hidden = true;
    problem.setAttribute("role", "alert");
    select.setAttribute("aria-describedby", problem.id);
    fill_choice(select, choices, this.scene!.choices[part]);
    const chosen = select.selectedOptions[0];
    if (chosen && text !== "") chosen.text = text;
    select.addEventListener("change", () => {
      for (const field of this.fields.values()) field.problem.hidden = true;
      this.send(part, select.value);
    });
    this.fields.set(part, { select, problem });
    return make("label", "field", make("span", "", title), select, problem);
  }
}
