// Three sentences for who opens the page for the first time, on a small screen one after the other.
// Once dismissed they stay away.

import { make, make_button } from "../page";
import { remember, remembered } from "../remembered";

export const SENTENCES = [
  "This is the robot, in blue: it makes your hand feel the twin, in orange.",
  "Drag the ringed handle: the red arrow is the force of your hand.",
  "The panel names what holds your hand; a dotted word opens its meaning.",
];

const STORED_AS = "hapticgiant.guide";
const STATES = ["shown", "dismissed"] as const;

export function show_guide(parent: HTMLElement): void {
  if (remembered(STORED_AS, STATES, "shown") === "dismissed") return;
  const items = SENTENCES.map((sentence) => make("li", "", sentence));
  const dismiss = make_button("Got it", "Do not show this again", () => {
    remember(STORED_AS, "dismissed");
    card.remove();
  });
  const next = make_button("Next", "The next of three sentences", () => {
    const now = items.findIndex(({ dataset }) => dataset.now === "true");
    show_step(now + 1);
    if (now + 2 === items.length) dismiss.focus();
  });
  next.className = "next";
  const show_step = (step: number): void => {
    items.forEach((item, i) => (item.dataset.now = String(i === step)));
    next.hidden = step === items.length - 1;
  };
  show_step(0);
  const card = make("section", "", make("ol", "", ...items), next, dismiss);
  card.id = "guide";
  card.setAttribute("aria-label", "First steps");
  parent.append(card);
}
