// Tabs above the sections of the panel.

import { element, make_button } from "../page";

const TABS = [
  ["feel", "Feel", "Why do I feel this?"],
  ["joints", "Joints", "Joints of twin and device"],
  ["change", "Change", "Twin, law, person and parameters"],
  ["safety", "Safety", "What stops it, and the operator's panel"],
  ["events", "Events", "What has happened"],
] as const;

type Tab = (typeof TABS)[number][0];

export class Tabs {
  private readonly buttons = new Map<Tab, HTMLButtonElement>();

  constructor() {
    for (const [tab, text, title] of TABS) {
      const button = make_button(text, title, () => this.show(tab));
      button.setAttribute("role", "tab");
      button.id = `tab-${tab}`;
      this.buttons.set(tab, button);
      element("tabs").append(button);
    }
    this.show("feel");
  }

  show(shown: Tab): void {
    for (const [tab, button] of this.buttons) {
      button.setAttribute("aria-selected", String(tab === shown));
      element(tab).hidden = tab !== shown;
    }
  }
}
