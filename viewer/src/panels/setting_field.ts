// The form field of one Setting: a slider and a box for the number. A value that is refused stays in
// the box, beside why, until it is corrected or put back.

import type { Setting } from "../messages";
import { make, make_button, write } from "../page";
import { unit_text } from "../text";
import { limited, number_text, place_of, value_at } from "./slider";

const SLIDER_STEPS = 1000;

export class SettingField {
  readonly part: HTMLElement;
  private readonly slider = make("input");
  private readonly box = make("input");
  private readonly note = make("p", "problem");
  private readonly reason = make("span");
  private readonly back: HTMLButtonElement;
  private value: number | null;
  private before: number | null; // as the program said last
  private is_refused = false;

  constructor(
    readonly setting: Setting,
    private readonly send: (setting: Setting, value: number, before: number | null) => void,
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
    this.value = this.before = setting.value;
    const unit = make("span", "unit", unit_text(setting.unit));
    const head = make("label", "", make("span", "", setting.label), this.box, unit);
    this.back = make_button("", "The value that holds", () => this.put_back());
    this.back.className = "small";
    this.note.id = `refused-${setting.name}`;
    this.note.setAttribute("role", "alert");
    this.note.append(this.reason, " ", this.back);
    this.part = make("div", "setting", head, this.slider, this.note);
    this.part.title = setting.help;
    this.show_refusal(false);
    this.slider.addEventListener("input", () => {
      this.change(value_at(Number(this.slider.value) / SLIDER_STEPS, setting));
    });
    this.box.addEventListener("change", () => this.read_box());
    this.part.addEventListener("focusout", () => this.show()); // what came meanwhile
    this.show();
  }

  // From the program.
  take(value: number | null): void {
    this.value = this.before = value;
    const is_in_use = this.part.contains(document.activeElement);
    if (!is_in_use) this.show();
  }

  refuse(reason: string): void {
    write(this.reason, reason);
    this.value = this.before;
    this.show_refusal(true);
    this.show();
  }

  private read_box(): void {
    const text = this.box.value.trim().replace(",", ".");
    const value = Number(text);
    const { min, max } = this.setting;
    if (text === "" || !Number.isFinite(value) || value !== limited(value, this.setting)) {
      this.refuse(`a number from ${number_text(min)} to ${number_text(max)} is expected`);
    } else {
      this.change(value);
    }
  }

  private change(value: number): void {
    this.show_refusal(false);
    this.value = value;
    this.send(this.setting, value, this.before);
    this.show();
  }

  private put_back(): void {
    this.show_refusal(false);
    this.show();
    this.box.focus();
  }

  private show_refusal(is_refused: boolean): void {
    this.is_refused = is_refused;
    this.note.hidden = !is_refused;
    this.box.setAttribute("aria-invalid", String(is_refused));
    if (is_refused) this.box.setAttribute("aria-describedby", this.note.id);
    else this.box.removeAttribute("aria-describedby");
    write(this.back, `keep ${this.value === null ? "unlimited" : number_text(this.value)}`);
  }

  private show(): void {
    if (!this.is_refused) this.box.value = this.value === null ? "" : number_text(this.value);
    const place = this.value === null ? 1 : place_of(this.value, this.setting);
    this.slider.value = String(Math.round(SLIDER_STEPS * place));
  }
}
