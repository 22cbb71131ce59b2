// Who has the hand, where it is not this page, and the way to ask for it.

import type { Commands } from "../data/commands";
import type { Frame, Scene } from "../messages";
import { element, make, make_button, write } from "../page";

// Whether another page has it.
export function is_taken(frame: Pick<Frame, "hand_page"> | null, own_page: number): boolean {
  return frame !== null && frame.hand_page !== 0 && frame.hand_page !== own_page;
}

// What is to be said about it; empty: nothing.
export function holder_text(
  { hand_page, hand_asked_by }: Pick<Frame, "hand_page" | "hand_asked_by">,
  own_page: number,
): string {
  if (hand_page === 0) return "";
  if (hand_page === own_page) {
    return hand_asked_by === 0 ? "" : `Page ${hand_asked_by} asks for the hand: let go to give it.`;
  }
  const asked = hand_asked_by === own_page ? " You have asked for it." : "";
  return `Page ${hand_page} has the hand.${asked}`;
}

export class HolderNote {
  private readonly part = element("holder");
  private readonly text = make("span");
  private readonly ask: HTMLButtonElement;
  private can_ask = false;

  constructor(
    commands: Commands,
    private readonly own_page: () => number,
  ) {
    this.ask = make_button("Ask for it", "The page that has the hand says so to who drags it", () =>
      commands.send("ask_for_hand"),
    );
    this.ask.id = "ask-for-hand";
    this.part.append(this.text, this.ask);
  }

  load(scene: Scene): void {
    this.can_ask = scene.commands.includes("ask_for_hand");
    this.part.hidden = true;
  }

  show(frame: Frame): void {
    const own = this.own_page();
    const text = holder_text(frame, own);
    write(this.text, text);
    this.part.hidden = text === "";
    this.ask.hidden = !this.can_ask || !is_taken(frame, own) || frame.hand_asked_by === own;
  }
}
