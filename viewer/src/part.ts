// A part of the page, for a page that shows it inside itself: `show=hand` in the address, after the
// token, is scene, handle and stop for who holds the handle; `show=trial` leaves out what another
// program decides, scenario and time, and the hand, which is the participant's. `show=picture` is the
// scene alone (film.ts).

import { page_options } from "./data/token";

const PARTS = ["hand", "trial", "picture"];

export function offers_hand(): boolean {
  return page_options().get("show") !== "trial";
}

export function show_part(): void {
  const part = page_options().get("show") ?? "";
  if (!PARTS.includes(part)) return;
  document.body.dataset.show = part;
  addEventListener("keydown", keep_time_from_page, { capture: true });
}

function keep_time_from_page(event: KeyboardEvent): void {
  if (["p", ".", "r"].includes(event.key)) event.stopImmediatePropagation();
}
