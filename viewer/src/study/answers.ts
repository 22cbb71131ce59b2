// What is answered of a form, and its draft: kept for this tab until the answers are accepted.

import type { Form, Item, Pair, ParticipantState } from "./messages";

interface Draft {
  answers: Record<string, number | string>;
  winners: Record<string, string>; // by pair
  order: Pair[]; // drawn, also which is left
  at: number; // the pair that is asked; -1: the items
}

function pair_name([first, second]: Pair): string {
  return `${first}/${second}`;
}

function is_answered(item: Item, answers: Draft["answers"]): boolean {
  return item.kind === "text" || typeof answers[item.name] === "number";
}

export function missing_items(form: Form, answers: Draft["answers"]): Item[] {
  return form.items.filter((item) => !is_answered(item, answers));
}

// A text that was not written is an empty one.
export function all_answers(form: Form, answers: Draft["answers"]): Draft["answers"] {
  return Object.fromEntries(
    form.items.flatMap((item) => {
      const answer = answers[item.name] ?? (item.kind === "text" ? "" : undefined);
      return answer === undefined ? [] : [[item.name, answer]];
    }),
  );
}

// All pairs in an order drawn with `random` (0..1), each either way round.
export function drawn(pairs: Pair[], random: () => number): Pair[] {
  const order = pairs.map(([a, b]): Pair => (random() < 0.5 ? [a, b] : [b, a]));
  for (let i = order.length - 1; i > 0; i--) {
    const j = Math.floor(random() * (i + 1));
    [order[i], order[j]] = [order[j]!, order[i]!];
  }
  return order;
}

// The name that the server gave to a pair, whichever way round it is asked.
export function name_of_pair(form: Form, [a, b]: Pair): string {
  const asked = form.pairs.find(([x, y]) => (x === a && y === b) || (x === b && y === a));
  return pair_name(asked ?? [a, b]);
}

// Whose drafts they are: of a person in a study, so that a rehearsal's never come up in the real one.
export function owner_of({ draft, code }: ParticipantState): string {
  return `${draft} ${code ?? ""}`;
}

const PREFIX = "hapticgiant.draft.";

function key_of(owner: string, position: number, form: string): string {
  return `${PREFIX}${owner}.${position}.${form}`;
}

export class DraftStore {
  private readonly key: string;
  readonly draft: Draft;

  constructor(
    owner: string,
    position: number,
    form: Form,
    private readonly storage: Storage = sessionStorage,
    random: () => number = Math.random,
  ) {
    this.key = key_of(owner, position, form.name);
    const kept = this.storage.getItem(this.key);
    this.draft = kept
      ? (JSON.parse(kept) as Draft)
      : { answers: {}, winners: {}, order: drawn(form.pairs, random), at: -1 };
  }

  keep(): void {
    this.storage.setItem(this.key, JSON.stringify(this.draft));
  }

  forget(): void {
    this.storage.removeItem(this.key);
  }
}

// Drafts of steps of this person that are over: their answers have been accepted.
export function forget_other_drafts(owner: string, position: number, storage: Storage = sessionStorage): void {
  const names = Array.from({ length: storage.length }, (_, i) => storage.key(i) ?? "");
  for (const name of names) {
    if (!name.startsWith(`${PREFIX}${owner}.`)) continue;
    if (!name.startsWith(`${PREFIX}${owner}.${position}.`)) storage.removeItem(name);
  }
}
