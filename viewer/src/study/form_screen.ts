// A form: its items on one screen, then its pairs one by one, then the answers are sent.

import { make, make_button, write } from "../page";
import { all_answers, DraftStore, missing_items, name_of_pair, owner_of } from "./answers";
import { item_view, name_and_question, type ItemView } from "./items";
import { show_markdown } from "./markdown";
import type { Form, Json, Pair, ParticipantState } from "./messages";
import { heading_of, main_button, type Desk, type Screen } from "./screens";
import type { Outcome } from "./study_link";

interface FormDesk extends Desk {
  submit(answers: Json): Promise<Outcome>;
}

export function form_screen(desk: FormDesk, state: ParticipantState): Screen {
  const form = state.form!;
  const position = state.position ?? 0;
  const store = new DraftStore(owner_of(state), position, form);
  const root = make("div", "form");
  const screen: Screen = { root, heading: make("h1") };
  const show = (is_first: boolean): void => {
    const { at, order } = store.draft;
    const part = at < 0 ? items_part(desk, form, store, turn) : pairs_part(desk, form, store, turn);
    screen.heading = part.heading;
    root.replaceChildren(part.root);
    root.dataset.part = at < 0 ? "items" : at < order.length ? "pair" : "send";
    if (is_first) return;
    scrollTo(0, 0);
    part.heading.focus();
  };
  const turn = (at: number): void => {
    store.draft.at = at;
    store.keep();
    show(false);
  };
  show(true);
  return screen;
}

type Turn = (at: number) => void;

function items_part(desk: FormDesk, form: Form, store: DraftStore, turn: Turn): Screen {
  const { words } = desk;
  const heading = heading_of(words[form.kind]);
  const about = make("div", "prose");
  if (form.about) show_markdown(about, form.about);
  const kinds = new Set(form.items.map(({ kind }) => kind));
  const hints = [
    ...(kinds.has("slider") || kinds.has("likert") ? [words.all_needed] : []),
    ...(kinds.has("slider") ? [words.tlx_hint] : []),
    ...(kinds.has("likert") ? [words.likert_hint] : []),
  ];
  const views = new Map<string, ItemView>();
  for (const item of form.items) {
    const on_answer = (answer: number | string): void => {
      store.draft.answers[item.name] = answer;
      store.keep();
    };
    const answer = store.draft.answers[item.name];
    views.set(item.name, item_view({ item, form, words, answer, on_answer }));
  }
  const has_pairs = form.pairs.length > 0;
  const sender = new Sender(desk, form, store);
  const go = main_button(has_pairs ? words.continue : words.send, () => {
    const missing = missing_items(form, store.draft.answers);
    for (const [name, view] of views) view.mark_missing(missing.some((item) => item.name === name));
    if (missing.length > 0) {
      sender.show_problem(words.missing(missing.length));
      views.get(missing[0]!.name)!.focus();
    } else if (has_pairs) turn(0);
    else void sender.send(go);
  });
  const parts = [...views.values()].map(({ root }) => root);
  const hint = make("p", "lead", hints.join(" "));
  const root = make("div", "page", heading, about, hint, ...parts, sender.problem, go);
  return { root, heading };
}

function pairs_part(desk: FormDesk, form: Form, store: DraftStore, turn: Turn): Screen {
  const { at, order } = store.draft;
  const pair = order[at];
  return pair ? pair_part(desk, form, store, turn, pair) : send_part(desk, form, store, turn);
}

function back_button({ words }: Desk, on_click: () => void): HTMLButtonElement {
  const back = make_button(words.back, "", on_click);
  back.removeAttribute("title");
  back.className = "back";
  return back;
}

function pair_part({ words, ...desk }: FormDesk, form: Form, store: DraftStore, turn: Turn, pair: Pair): Screen {
  const { at, order, winners } = store.draft;
  const heading = heading_of(words.pair);
  const count = make("p", "lead", words.pair_count(at + 1, order.length));
  const key = name_of_pair(form, pair);
  const choose = (name: string): void => {
    winners[key] = name;
    turn(at + 1);
  };
  const buttons = pair.map((name, i) => {
    const item = form.items.find((each) => each.name === name)!;
    const [title, question] = name_and_question(form, item);
    const button = make("button", "pair", make("b", "", title || question));
    if (title !== "") button.append(make("span", "question", question));
    button.type = "button";
    button.setAttribute("aria-keyshortcuts", String(i + 1));
    button.setAttribute("aria-pressed", String(winners[key] === name));
    button.addEventListener("click", (event) => {
      if (event.detail < 2) choose(name); // the second click of a double one does nothing
    });
    return button;
  });
  const root = make(
    "div",
    "page pairs",
    heading,
    count,
    make("div", "two", ...buttons),
    make("p", "hint keys", words.pair_hint),
    back_button({ words, ...desk }, () => turn(at - 1)),
  );
  root.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
    const by_number = pair[Number(event.key) - 1];
    if (by_number !== undefined) choose(by_number);
    else if (event.key === "ArrowLeft" || event.key === "ArrowUp") buttons[0]!.focus();
    else if (event.key === "ArrowRight" || event.key === "ArrowDown") buttons[1]!.focus();
    else return;
    event.preventDefault();
  });
  return { root, heading };
}

function send_part(desk: FormDesk, form: Form, store: DraftStore, turn: Turn): Screen {
  const { words } = desk;
  const heading = heading_of(words.pairs_done);
  const text = make("p", "lead", words.pairs_done_text);
  const sender = new Sender(desk, form, store);
  const go = main_button(words.send, () => void sender.send(go));
  const back = back_button(desk, () => turn(store.draft.order.length - 1));
  return { root: make("div", "page", heading, text, sender.problem, go, back), heading };
}

// Sends the answers; what was refused or lost can be sent again.
class Sender {
  readonly problem = make("p", "problem alert");
  private is_sending = false;

  constructor(
    private readonly desk: FormDesk,
    private readonly form: Form,
    private readonly store: DraftStore,
  ) {
    this.problem.setAttribute("role", "alert");
  }

  show_problem(text: string): void {
    write(this.problem, text);
  }

  async send(button: HTMLButtonElement): Promise<void> {
    if (this.is_sending) return;
    const { desk, form, store } = this;
    const { words } = desk;
    this.is_sending = true;
    write(button, words.sending);
    button.setAttribute("aria-disabled", "true");
    this.show_problem("");
    const answers = all_answers(form, store.draft.answers);
    const outcome = await desk.submit({ answers, pairs: store.draft.winners });
    this.is_sending = false;
    if (outcome.kind === "done") return store.forget(); // the next screen comes
    write(button, words.send);
    button.removeAttribute("aria-disabled");
    this.show_problem(outcome.kind === "lost" ? words.not_sent : words.refused(outcome.problem));
  }
}
