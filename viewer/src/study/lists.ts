// Lists of the operator's page: participants, steps, the last trial, notes, markers.

import { element, make, make_button } from "../page";
import type { Last, OperatorState } from "./messages";
import { exit_text, missing_text, number_text, person_text, step_text } from "./operator_text";

const shown = new Map<string, string>();

// Builds the content of `id` when what it shows has changed.
function refresh(id: string, of: unknown, build: () => HTMLElement[]): boolean {
  const wanted = JSON.stringify(of);
  if (shown.get(id) === wanted) return false;
  shown.set(id, wanted);
  element(id).replaceChildren(...build());
  return true;
}

function unseen_mark(text: string): HTMLElement {
  const mark = make("span", "mark", text);
  mark.setAttribute("aria-hidden", "true");
  return mark;
}

export function show_people(state: OperatorState, begin: (code: string) => void): void {
  const { participants, next, participant } = state;
  const can_begin = state.can.includes("begin");
  const is_changed = refresh("people-list", [participants, next, participant, can_begin], () =>
    participants.map((person) => {
      const { code, status, conditions } = person;
      const is_open = code === participant;
      const is_next = code === next && participant === null;
      const what = is_open ? "open" : is_next ? `next; ${person_text(person)}` : person_text(person);
      const item = make(
        "li",
        "",
        unseen_mark(is_open ? "\u25b6" : status === "complete" ? "\u2713" : is_next ? "\u2192" : ""),
        make("b", "", code),
        make("span", "what", what),
        make("small", "", conditions.join(", ")),
      );
      item.dataset.status = is_open ? "open" : is_next ? "next" : status;
      if (can_begin && !is_next && (status === "planned" || status === "begun")) {
        const button = make_button(status === "begun" ? "Continue" : "Begin", "", () => begin(code));
        button.removeAttribute("title");
        button.setAttribute("aria-label", `${button.textContent} ${code}`);
        item.append(button);
      }
      return item;
    }),
  );
  if (is_changed) scroll_to("people-list", "[data-status=open], [data-status=next]");
}

// Brings the item to the middle of its list.
function scroll_to(id: string, selector: string): void {
  const list = element(id);
  const item = list.querySelector<HTMLElement>(selector);
  if (item) list.scrollTop = item.offsetTop - list.clientHeight / 2;
}

export function show_steps({ steps, position, participant }: OperatorState): void {
  element("steps").hidden = participant === null;
  const is_changed = refresh("steps-list", [steps, position], () =>
    steps.map((step, i) => {
      const is_present = i === position;
      const state = step.is_done ? "done" : is_present ? "now" : "to come";
      const item = make(
        "li",
        "",
        unseen_mark(step.is_done ? "\u2713" : is_present ? "\u25b6" : "\u25cb"),
        make("span", "", step_text(step)),
        make("span", "unseen", `, ${state}`),
      );
      if (is_present) item.setAttribute("aria-current", "step");
      item.dataset.state = is_present ? "now" : state;
      return item;
    }),
  );
  if (is_changed) scroll_to("steps-list", "[aria-current]");
}

export function show_last({ last }: OperatorState): void {
  element("last").hidden = last === null;
  if (last) refresh("last-content", last, () => last_content(last));
}

function last_content(last: Last): HTMLElement[] {
  const { condition, repetition, exit_code, excluded, missing_events, measures } = last;
  const rows = Object.entries(measures).map(([name, { value, unit, why }]) =>
    value === null
      ? make("tr", "", row_head(name), none_because(why))
      : make("tr", "", row_head(name), make("td", "", number_text(value)), make("td", "unit", unit)),
  );
  const verdict = make("p", "verdict", excluded === "" ? "counts" : `left out: ${excluded}`);
  verdict.dataset.counts = String(excluded === "");
  verdict.prepend(unseen_mark(excluded === "" ? "\u2713" : "\u26a0"));
  return [
    make("p", "", `${condition}, ${repetition}: ${exit_text(exit_code)}`),
    ...(missing_events.length > 0 ? [make("p", "missing", missing_text(missing_events))] : []),
    verdict,
    make("table", "", make("tbody", "", ...rows)),
  ];
}

function none_because(why: string): HTMLTableCellElement {
  const cell = make("td", "none", why === "" ? number_text(null) : `${number_text(null)}: ${why}`);
  cell.colSpan = 2;
  return cell;
}

function row_head(name: string): HTMLElement {
  const head = make("th", "", name);
  head.scope = "row";
  return head;
}

export function show_notes({ notes }: OperatorState): void {
  refresh("notes-list", notes, () =>
    [...notes].reverse().map(({ step, text }) =>
      make("li", "", make("small", "", step === null ? "" : `step ${step + 1}`), make("span", "", text)),
    ),
  );
}

export function show_markers({ markers }: OperatorState): void {
  element("markers").hidden = markers.length === 0;
  refresh("markers-list", markers, () =>
    markers.map(({ name, is_connected, count }) => {
      const what = is_connected ? `${count} received` : `not connected, ${count} received`;
      const item = make("li", "", unseen_mark(is_connected ? "\u2713" : "\u26a0"), make("b", "", name));
      item.append(make("span", "what", what));
      item.dataset.connected = String(is_connected);
      return item;
    }),
  );
}
