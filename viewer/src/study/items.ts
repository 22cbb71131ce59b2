// Questions of a form: scale, row of choices, text. None has an answer before it is touched.

import { make, write } from "../page";
import type { Form, Item } from "./messages";
import { count_of, marks_of, share_of, value_after, value_at } from "./scale";
import type { Words } from "./words";

export interface ItemView {
  root: HTMLElement;
  focus(): void;
  mark_missing(is_missing: boolean): void;
}

interface Asked {
  item: Item;
  form: Form;
  words: Words;
  answer: number | string | undefined;
  on_answer(answer: number | string): void;
}

const SCROLL_PX = 16; // a finger that goes further up or down than that scrolls

let count = 0;

// "Effort: how hard ...?" has a name and a question.
export function name_and_question(form: Form, item: Item): [string, string] {
  const at = form.kind === "nasa_tlx" ? item.text.indexOf(": ") : -1;
  return at < 0 ? ["", item.text] : [item.text.slice(0, at), item.text.slice(at + 2)];
}

function question_text(form: Form, item: Item): (HTMLElement | string)[] {
  const [name, question] = name_and_question(form, item);
  if (name === "") return [question];
  const first = question.charAt(0).toUpperCase() + question.slice(1);
  return [make("b", "", name), " ", make("span", "question", first)];
}

export function item_view(asked: Asked): ItemView {
  const { kind } = asked.item;
  if (kind === "likert") return choices(asked);
  return kind === "slider" ? scale(asked) : text(asked);
}

function problem_line(words: Words): HTMLElement {
  const line = make("p", "problem", words.needed);
  line.id = `problem-${++count}`;
  line.hidden = true;
  return line;
}

function ends_line({ ends }: Item): HTMLElement {
  const [low = "", high = ""] = ends;
  const line = make("div", "ends", make("span", "", low), make("span", "", high));
  line.hidden = low === "" && high === "";
  line.setAttribute("aria-hidden", "true"); // said with the values
  return line;
}

interface Slider {
  slider: HTMLElement;
  rail: HTMLElement;
  thumb: HTMLElement;
}

function slider_of(item: Item, label: HTMLElement): Slider {
  const rail = make("div", "rail");
  for (const share of marks_of(item)) {
    const mark = make("i");
    mark.style.left = `${100 * share}%`;
    rail.append(mark);
  }
  const thumb = make("b", "thumb");
  rail.append(thumb);
  const slider = make("div", "scale", rail);
  slider.tabIndex = 0;
  slider.setAttribute("role", "slider");
  slider.setAttribute("aria-labelledby", label.id);
  slider.setAttribute("aria-valuemin", String(item.low));
  slider.setAttribute("aria-valuemax", String(item.high));
  return { slider, rail, thumb };
}

function scale({ item, form, words, answer, on_answer }: Asked): ItemView {
  const label = make("p", "label", ...question_text(form, item));
  label.id = `label-${++count}`;
  const problem = problem_line(words);
  const { slider, rail, thumb } = slider_of(item, label);
  const shown = make("output", "value");
  shown.hidden = form.kind === "nasa_tlx"; // as on paper
  const [low = "", high = ""] = item.ends;
  let value = typeof answer === "number" ? answer : null;

  const show = (): void => {
    slider.dataset.answered = String(value !== null);
    slider.setAttribute("aria-valuenow", String(value ?? item.low));
    const said = value === null ? words.not_answered : words.between(String(value), low, high);
    slider.setAttribute("aria-valuetext", said);
    write(shown, value === null ? words.not_answered : String(value));
    thumb.hidden = value === null;
    thumb.style.left = `${100 * share_of(item, value ?? item.low)}%`;
  };
  const mark_missing = (is_missing: boolean): void => {
    problem.hidden = !is_missing;
    if (is_missing) slider.setAttribute("aria-describedby", problem.id);
    else slider.removeAttribute("aria-describedby");
    slider.setAttribute("aria-invalid", String(is_missing));
  };
  const take = (chosen: number | null): void => {
    value = chosen;
    show();
    if (value === null) return;
    mark_missing(false);
    on_answer(value);
  };
  slider.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const next = value_after(item, value, event.key);
    if (next === null) return;
    event.preventDefault();
    take(next);
  });
  point(slider, rail, {
    get: () => value,
    set: (share) => {
      value = share === null ? null : value_at(item, share);
      show();
    },
    restore: (before) => {
      value = before;
      show();
    },
    end: () => take(value),
  });
  show();
  const root = make("div", "item", label, slider, ends_line(item), shown, problem);
  return { root, focus: () => slider.focus(), mark_missing };
}

interface Pointed {
  get(): number | null;
  set(share: number | null): void;
  restore(before: number | null): void;
  end(): void;
}

// Mouse and finger on a scale; a finger that scrolls the page answers nothing.
function point(slider: HTMLElement, rail: HTMLElement, pointed: Pointed): void {
  let before: number | null = null;
  let pointer: number | null = null;
  const move = ({ clientX }: PointerEvent): void => {
    const { left, width } = rail.getBoundingClientRect();
    pointed.set((clientX - left) / width);
  };
  let start = { x: 0, y: 0 };
  const forget = (): void => {
    pointer = null;
    pointed.restore(before);
  };
  slider.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || pointer !== null) return;
    start = { x: event.clientX, y: event.clientY };
    before = pointed.get();
    pointer = event.pointerId;
    slider.setPointerCapture(pointer);
    move(event);
  });
  slider.addEventListener("pointermove", (event) => {
    if (event.pointerId !== pointer) return;
    const down = Math.abs(event.clientY - start.y);
    const is_scrolling = down > SCROLL_PX && down > Math.abs(event.clientX - start.x);
    if (event.pointerType === "touch" && is_scrolling) forget();
    else move(event);
  });
  slider.addEventListener("pointerup", (event) => {
    if (event.pointerId !== pointer) return;
    pointer = null;
    pointed.end();
  });
  slider.addEventListener("pointercancel", () => {
    if (pointer !== null) forget();
  });
}

function choices({ item, form, words, answer, on_answer }: Asked): ItemView {
  const group = `choice-${++count}`;
  const problem = problem_line(words);
  const row = make("div", "choices");
  const [low = "", high = ""] = item.ends;
  const inputs: HTMLInputElement[] = [];
  const points = count_of(item);
  for (let i = 0; i < points; i++) {
    const value = item.low + i * item.step;
    const input = make("input");
    input.type = "radio";
    input.name = group;
    input.value = String(value);
    input.checked = answer === value;
    const end = i === 0 ? low : i === points - 1 ? high : "";
    const meaning = make("span", "unseen", end === "" ? "" : `: ${end}`);
    row.append(make("label", "choice", input, make("span", "", String(value)), meaning));
    inputs.push(input);
  }
  row.style.gridTemplateColumns = `repeat(${points}, minmax(0, 1fr))`;
  const root = make(
    "fieldset",
    "item",
    make("legend", "label", ...question_text(form, item)),
    row,
    ends_line(item),
    problem,
  );
  root.setAttribute("role", "radiogroup");
  root.setAttribute("aria-required", "true");
  const mark_missing = (is_missing: boolean): void => {
    problem.hidden = !is_missing;
    root.setAttribute("aria-invalid", String(is_missing));
    if (is_missing) root.setAttribute("aria-describedby", problem.id);
    else root.removeAttribute("aria-describedby");
  };
  root.addEventListener("change", () => {
    const chosen = inputs.find((input) => input.checked);
    if (!chosen) return;
    mark_missing(false);
    on_answer(Number(chosen.value));
  });
  root.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const typed = inputs.find(({ value }) => value === event.key);
    if (!typed) return;
    event.preventDefault();
    typed.focus();
    typed.click();
  });
  const focus = (): void => (inputs.find((input) => input.checked) ?? inputs[0])?.focus();
  return { root, focus, mark_missing };
}

function text({ item, form, words, answer, on_answer }: Asked): ItemView {
  const area = make("textarea");
  area.rows = 4;
  area.id = `text-${++count}`;
  area.value = typeof answer === "string" ? answer : "";
  const hint = make("p", "hint", words.no_names);
  hint.id = `hint-${count}`;
  area.setAttribute("aria-describedby", hint.id);
  area.addEventListener("input", () => on_answer(area.value));
  const label = make("label", "label", ...question_text(form, item));
  label.htmlFor = area.id;
  const root = make("div", "item", label, hint, area);
  return { root, focus: () => area.focus(), mark_missing: () => {} };
}
