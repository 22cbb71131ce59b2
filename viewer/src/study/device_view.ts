// What the device does: state, force, events that are expected and have happened.

import { element, make, write } from "../page";
import { ForceView } from "./force_view";
import type { Run } from "./messages";
import { event_rows } from "./operator_text";

export class DeviceView {
  private readonly force = new ForceView(element("force"));
  private readonly mode = make("dd");
  private readonly held = make("dd");
  private readonly time = make("dd");
  private shown_events = "";

  constructor() {
    element("device-facts").append(
      make("div", "", make("dt", "", "Mode"), this.mode),
      make("div", "", make("dt", "", "Handle"), this.held),
      make("div", "", make("dt", "", "Time"), this.time),
    );
    this.show(null);
  }

  show(run: Run | null): void {
    write(this.mode, run ? run.mode : "no run");
    write(this.held, run ? (run.is_held ? "held" : "not held") : "-");
    write(this.time, run && run.time_s !== null ? `${run.time_s.toFixed(1)} s` : "-");
    this.mode.dataset.mode = run?.mode ?? "";
    write(element("device-fault"), run?.fault ?? "");
    element("force").dataset.known = String(run !== null);
    if (run) this.force.show(run.time_s, run.force_N);
    else this.force.clear();
    this.show_events(run);
  }

  private show_events(run: Run | null): void {
    const rows = run ? event_rows(run) : [];
    const wanted = JSON.stringify([run !== null, rows]);
    if (wanted === this.shown_events) return;
    this.shown_events = wanted;
    const items = rows.map(({ name, time_s, is_expected }) => {
      const state = time_s === null ? "expected" : is_expected ? "happened" : "also happened";
      const mark = make("span", "mark", time_s === null ? "\u25cb" : is_expected ? "\u2713" : "+");
      mark.setAttribute("aria-hidden", "true");
      const when = make("span", "when", time_s === null ? state : `${time_s.toFixed(1)} s`);
      const item = make("li", "", mark, make("span", "", name), when);
      item.dataset.state = state.replaceAll(" ", "-");
      return item;
    });
    const none = "None are expected, none have happened.";
    element("events-list").replaceChildren(...(items.length > 0 ? items : [make("li", "none", none)]));
  }
}
