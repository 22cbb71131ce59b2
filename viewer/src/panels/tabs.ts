// Tabs above the sections of the panel: by click, or by arrows from the one that has the focus.

import type { Scene } from "../messages";
import { element, make_button } from "../page";
import { remember, remembered } from "../remembered";

const TABS = [
  ["feel", "Feel", "Why do I feel this?"],
  ["joints", "Joints", "Joints of twin and device"],
  ["remote", "Remote", "Teleoperation: the remote machine, the link to it, and who holds whom"],
  ["change", "Change", "Twin, device, surfaces, law, person and parameters"],
  ["safety", "Safety", "What stops it, and the operator's panel"],
  ["events", "Events", "What has happened"],
] as const;

type Tab = (typeof TABS)[number][0];

const STORED_AS = "hapticgiant.tab";
const NAMES = TABS.map(([tab]) => tab);
const STEPS: Record<string, number> = { ArrowLeft: -1, ArrowRight: 1 };

export class Tabs {
  private readonly buttons = new Map<Tab, HTMLButtonElement>();

  constructor() {
    const list = element("tabs");
    for (const [tab, text, title] of TABS) {
      const button = make_button(text, title, () => this.show(tab));
      button.setAttribute("role", "tab");
      button.setAttribute("aria-controls", tab);
      button.id = `tab-${tab}`;
      this.buttons.set(tab, button);
      list.append(button);
      const part = element(tab);
      part.setAttribute("role", "tabpanel");
      part.setAttribute("aria-labelledby", button.id);
      part.tabIndex = 0; // it scrolls by keys
    }
    list.addEventListener("keydown", (event) => this.step(event));
    this.buttons.get("remote")!.hidden = true;
    const last = remembered(STORED_AS, NAMES, "feel");
    this.show(last === "remote" ? "feel" : last);
  }

  // Of a run without a remote machine the tab `remote` is left out.
  load({ teleoperation }: Scene): void {
    const was_offered = !this.buttons.get("remote")!.hidden;
    const is_offered = teleoperation !== null;
    this.buttons.get("remote")!.hidden = !is_offered;
    element("tabs").dataset.isFull = String(is_offered);
    if (is_offered && !was_offered) this.show("remote");
    else if (!is_offered && !element("remote").hidden) this.show("feel");
  }

  show(shown: Tab): void {
    for (const [tab, button] of this.buttons) {
      button.setAttribute("aria-selected", String(tab === shown));
      button.tabIndex = tab === shown ? 0 : -1;
      element(tab).hidden = tab !== shown;
    }
    remember(STORED_AS, shown);
  }

  private step(event: KeyboardEvent): void {
    const step = STEPS[event.key];
    const from = NAMES.findIndex((tab) => !element(tab).hidden);
    if (step === undefined || from < 0) return;
    const names = NAMES.filter((name) => !this.buttons.get(name)!.hidden);
    const next = names[(names.indexOf(NAMES[from]!) + step + names.length) % names.length]!;
    event.preventDefault();
    this.show(next);
    this.buttons.get(next)!.focus();
  }
}
