// Every technical word of the panel opens its meaning, by mouse, touch and keys. Words of buttons
// and fields, which do something else, and of texts with measured values, which change too often to
// be clicked, are listed at the end of their section.

import { make, make_button } from "../page";
import { type Entry, WORDS, words_in } from "./words";

const NOT_INSIDE = "button, select, label, input, footer, .glossary-words";
const CHANGES = /\d[.%\u00b0]|\d (?:%|N|Nm|cm|mm)\b/; // a measured value
const GAP = 6; // px, between a word and its meaning

export class Glossary {
  private readonly card = make("div");
  private readonly title = make("h2");
  private readonly text = make("p");
  private readonly all = make("dl");
  private readonly all_button = make_button("All words", "The whole glossary", () => this.show_all());
  private readonly watch: MutationObserver;

  // `panel`: with the sections whose words are explained.
  constructor(private readonly panel: HTMLElement) {
    this.card.id = "glossary";
    this.card.popover = "auto"; // a click elsewhere closes it
    this.card.setAttribute("role", "dialog");
    this.title.id = "glossary-title";
    this.card.setAttribute("aria-labelledby", this.title.id);
    this.card.tabIndex = -1;
    const close = make_button("Close", "Esc stops the device as well", () => this.card.hidePopover());
    this.card.append(this.title, this.text, this.all);
    this.card.append(make("div", "buttons", this.all_button, close));
    document.body.append(this.card);
    const open = make_button("Glossary", "All words of this page", () => {
      this.card.showPopover();
      this.show_all();
    });
    open.className = "small";
    open.id = "open-glossary";
    panel.querySelector("footer")?.append(open);
    panel.addEventListener("click", ({ target }) => this.take_click(target as Element));
    this.watch = new MutationObserver((changes) => this.follow(changes));
    this.mark(panel);
    this.observe();
  }

  private observe(): void {
    this.watch.takeRecords(); // its own changes
    this.watch.observe(this.panel, { childList: true, subtree: true, characterData: true });
  }

  private follow(changes: MutationRecord[]): void {
    const changed = new Set(changes.map(({ target }) => target));
    for (const node of changed) if (node.isConnected) this.mark(node);
    this.observe();
  }

  private mark(root: Node): void {
    const texts = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
    const found: Text[] = [];
    if (root instanceof Text) found.push(root);
    while (texts.nextNode()) found.push(texts.currentNode as Text);
    for (const text of found) {
      const words = words_in(text.data);
      const parent = text.parentElement;
      if (words.length === 0 || !parent || parent.closest(".term, .glossary-words")) continue;
      const is_fixed = !CHANGES.test(text.data) && !parent.closest(NOT_INSIDE);
      const section = parent.closest("#panel > :not(footer, #tabs)");
      if (is_fixed) wrap(text, words);
      else if (section) list_words(section, words);
    }
  }

  private take_click(target: Element): void {
    const button = target.closest<HTMLElement>(".term");
    if (!button) return;
    const entry = WORDS.find(({ word }) => word === button.dataset.term);
    if (entry) this.show(entry, button);
  }

  private show({ word, text }: Entry, button: HTMLElement): void {
    this.title.textContent = word;
    this.text.textContent = text;
    this.all.replaceChildren();
    this.text.hidden = this.all_button.hidden = false;
    this.card.showPopover();
    const at = button.getBoundingClientRect();
    this.place(at.left, at.bottom + GAP, at.top - GAP);
    this.card.focus();
  }

  private show_all(): void {
    this.title.textContent = "Glossary";
    this.text.hidden = this.all_button.hidden = true;
    const sorted = [...WORDS].sort((a, b) => a.word.localeCompare(b.word));
    this.all.replaceChildren(
      ...sorted.flatMap(({ word, text }) => [make("dt", "", word), make("dd", "", text)]),
    );
    const { left } = this.card.getBoundingClientRect();
    this.place(left, 0, 0);
    this.card.focus();
  }

  // Below `top`, or above `bottom` where there is no room; all of it in the window.
  private place(left: number, top: number, bottom: number): void {
    const { offsetWidth: width, offsetHeight: height } = this.card;
    const has_room = top + height <= innerHeight;
    const y = has_room ? top : bottom - height;
    this.card.style.left = `${Math.max(GAP, Math.min(left, innerWidth - width - GAP))}px`;
    this.card.style.top = `${Math.max(GAP, y)}px`;
  }
}

// Makes buttons of the words of a text; what is read is the same as before.
function wrap(text: Text, words: ReturnType<typeof words_in>): void {
  const parts: (Node | string)[] = [];
  let from = 0;
  for (const { begin, end, entry } of words) {
    parts.push(text.data.slice(from, begin), term_button(text.data.slice(begin, end), entry));
    from = end;
  }
  parts.push(text.data.slice(from));
  text.replaceWith(...parts.filter((part) => part !== ""));
}

function term_button(text: string, { word }: Entry): HTMLButtonElement {
  const button = make("button", "term", text);
  button.type = "button";
  button.dataset.term = word;
  button.setAttribute("aria-haspopup", "dialog");
  return button;
}

// Adds words to the list at the end of a section.
function list_words(section: Element, words: ReturnType<typeof words_in>): void {
  let list = section.querySelector(":scope > .glossary-words");
  if (!list) {
    list = make("p", "glossary-words", "Words: ");
    section.append(list);
  }
  for (const { entry } of words) {
    const is_listed = list.querySelector(`[data-term="${entry.word}"]`) !== null;
    if (!is_listed) list.append(term_button(entry.word, entry), " ");
  }
}
