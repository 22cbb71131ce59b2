// What the operator can do now: big buttons, keys, and the reason where one is needed.

import { element, make, make_button, write } from "../page";
import type { Ability, Json, OperatorState } from "./messages";
import type { Outcome } from "./study_link";

type Action = "start" | "end" | "go_on" | "abort" | "repeat" | "leave";

interface Described {
  action: Action;
  text: string;
  key?: string;
  title: string;
  question?: string; // a reason is asked for
  confirm?: string;
}

const ACTIONS: Described[] = [
  { action: "start", text: "Start", key: "S", title: "Starts the trial" },
  { action: "end", text: "End", key: "E", title: "The trial is over, and counts" },
  { action: "go_on", text: "Go on", key: "G", title: "Continues for the participant" },
  {
    action: "abort",
    text: "Throw away\u2026",
    title: "Stops the trial; it is played again",
    question: "Why is this trial thrown away?",
    confirm: "Throw it away",
  },
  {
    action: "repeat",
    text: "Repeat last\u2026",
    title: "Puts the last trial aside; it is played again",
    question: "Why is the last trial played again?",
    confirm: "Play it again",
  },
  { action: "leave", text: "Close session", title: "It can be continued later" },
];
const LARGE: Action[] = ["start", "end", "go_on"];

export type Send = (command: Ability, content?: Json) => Promise<Outcome>;

// Keys belong to who types.
function is_writing(target: EventTarget | null): boolean {
  return target instanceof HTMLInputElement || target instanceof HTMLTextAreaElement;
}

export class Actions {
  private readonly buttons = new Map<Action, HTMLButtonElement>();
  private readonly begin = make_button("Begin", "", () => this.begin_next());
  private readonly why = element("why");
  private asked: Described | null = null;
  private state: OperatorState | null = null;

  constructor(private readonly send: Send) {
    this.begin.className = "large primary";
    this.begin.id = "begin";
    this.begin.removeAttribute("title");
    const [large, small] = [make("div", "row", this.begin), make("div", "row")];
    for (const described of ACTIONS) {
      const { action, text, key, title } = described;
      const button = make_button(text, title, () => this.press(described));
      button.id = `do-${action}`;
      if (key) {
        button.setAttribute("aria-keyshortcuts", key);
        const note = make("kbd", "", key);
        note.setAttribute("aria-hidden", "true");
        button.append(note);
      }
      const is_large = LARGE.includes(action);
      button.className = is_large ? "large" : "small";
      this.buttons.set(action, button);
      (is_large ? large : small).append(button);
    }
    element("actions").append(large, small);
    addEventListener("keydown", (event) => this.take_key(event));
  }

  show(state: OperatorState): void {
    const is_other_session = state.participant !== (this.state?.participant ?? null);
    this.state = state;
    const { can, next } = state;
    const is_closed = state.participant === null;
    this.begin.hidden = !is_closed;
    write(this.begin, next ? `Begin ${next}` : "Begin");
    enable(this.begin, can.includes("begin") && next !== null);
    for (const [action, button] of this.buttons) {
      button.hidden = is_closed;
      enable(button, can.includes(action));
    }
    const main = LARGE.find((action) => can.includes(action));
    const is_complete = state.phase === "complete";
    for (const [action, button] of this.buttons) {
      button.classList.toggle("primary", action === main || (action === "leave" && is_complete));
    }
    if (this.asked && !can.includes(this.asked.action)) this.close_question();
    if (is_other_session && is_focus_lost()) (main ? this.buttons.get(main)! : this.begin).focus();
  }

  private begin_next(): void {
    const next = this.state?.next;
    if (next && this.state?.can.includes("begin")) void this.send("begin", { code: next });
  }

  private press(described: Described): void {
    const { state } = this;
    if (!state?.can.includes(described.action)) return;
    if (described.question) return this.ask(described);
    void this.send(described.action, { position: state.position }); // of what was shown
  }

  private take_key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
    if (is_writing(event.target)) return;
    const described = ACTIONS.find(({ key }) => key === event.key.toUpperCase());
    if (described) this.press(described);
  }

  // Not a modal dialog: the stop must be there to press.
  private ask(described: Described): void {
    this.asked = described;
    const input = make("input");
    input.type = "text";
    input.id = "why-text";
    input.autocomplete = "off";
    const label = make("label", "", described.question!);
    label.htmlFor = input.id;
    const problem = make("p", "problem");
    problem.setAttribute("role", "alert");
    const confirm = make("button", "danger", described.confirm!);
    confirm.type = "submit";
    const cancel = make_button("Cancel", "", () => this.close_question());
    cancel.removeAttribute("title");
    const form = make("form", "", label, input, make("div", "row", confirm, cancel), problem);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const why = input.value.trim();
      if (why === "") {
        write(problem, "Please give a reason: it is kept with the study.");
        return input.focus();
      }
      void this.send(described.action, { why, position: this.state?.position ?? null }).then(({ kind }) => {
        if (kind === "done" && this.asked === described) this.close_question();
      });
    });
    this.why.replaceChildren(form);
    this.why.hidden = false;
    input.focus();
  }

  private close_question(): void {
    const { asked } = this;
    const had_focus = this.why.contains(document.activeElement);
    this.asked = null;
    this.why.hidden = true;
    this.why.replaceChildren();
    if (asked && had_focus) this.buttons.get(asked.action)!.focus();
  }
}

// What had it is not there any more.
function is_focus_lost(): boolean {
  const active = document.activeElement;
  return active === null || active === document.body || (active instanceof HTMLElement && active.hidden);
}

// A button that is not possible now keeps the focus.
function enable(button: HTMLButtonElement, is_possible: boolean): void {
  button.setAttribute("aria-disabled", String(!is_possible));
}
