// What has happened, the newest first.

import type { Event } from "../messages";
import { make } from "../page";
import { time_text } from "../text";

const MOST_EVENTS = 100;

export class EventsPanel {
  private readonly list = make("ol");

  constructor(section: HTMLElement) {
    section.append(this.list);
  }

  add({ time_s, name, text }: Event): void {
    const time = make("time", "", time_text(time_s));
    this.list.prepend(make("li", "", time, make("b", "", name), ` ${text}`));
    while (this.list.children.length > MOST_EVENTS) this.list.lastElementChild!.remove();
  }

  clear(): void {
    this.list.replaceChildren();
  }
}
