// "Teleoperation": who holds back whom, the clutch, both ends, the link, and how energy went.

import type { Store } from "../data/store";
import type { Frame, Scene } from "../messages";
import { fill, make, write } from "../page";
import { time_specs } from "../plots/specs";
import { TimePlot } from "../plots/time_plot";
import {
  apart_text,
  clutch_state,
  force_on_hand,
  force_text,
  link_text,
  method_text,
  who_holds,
} from "../remote_text";
import { on_theme_change } from "../theme";

const FULL_FORCE = 60; // N or Nm, of a full bar
const PLOT_S = 20;

export class RemotePanel {
  private readonly sentence = make("p", "reason");
  private readonly hand = make("output", "large");
  private readonly machine = make("output", "large");
  private readonly led = make("small");
  private readonly hand_bar = make("div", "bar force", make("i"));
  private readonly machine_bar = make("div", "bar remote", make("i"));
  private readonly method = make("p", "quiet");
  private readonly set_up = make("p", "quiet");
  private readonly values = new Map<string, HTMLElement>();
  private readonly energies = new Map<string, HTMLElement>();
  private readonly plot_part = make("div", "remote-plot");
  private plot: TimePlot | null = null;

  constructor(
    section: HTMLElement,
    private readonly store: Store,
  ) {
    this.sentence.id = "who-holds";
    const ends = make(
      "div",
      "wrench",
      make("div", "force", make("p", "", this.hand), this.hand_bar, this.led),
      make("div", "remote", make("p", "", this.machine), this.machine_bar, make("small", "", "on the remote machine")),
    );
    section.append(
      make("h2", "", "Teleoperation"),
      this.sentence,
      ends,
      make("h2", "", "Clutch"),
      this.list(this.values, ["clutch", "distance hand to remote"]),
      make("h2", "", "Link"),
      this.list(this.values, ["there and back", "jitter", "packets lost", "age of the newest packet"]),
      this.set_up,
      make("h2", "", "Energy"),
      this.list(this.energies, ["operator's port", "remote port", "dissipated"]),
      this.plot_part,
      make("h2", "", "Method"),
      this.method,
    );
    on_theme_change(() => this.store.scene && this.load(this.store.scene));
  }

  load(scene: Scene): void {
    this.plot?.dispose();
    this.plot = null;
    this.plot_part.replaceChildren();
    const { teleoperation } = scene;
    if (!teleoperation) return;
    write(this.led, teleoperation.mapping === "tool" ? "on your hand" : "on the joints of the twin");
    write(this.method, method_text(teleoperation));
    write(this.set_up, teleoperation.link === "" ? "" : `Simulated delay: ${teleoperation.link}.`);
    const spec = time_specs(scene).find(({ id }) => id === "remote-energy")!;
    this.plot = new TimePlot(spec, () => {});
    this.plot_part.append(this.plot.card);
  }

  show(scene: Scene, { teleoperation: now }: Frame): void {
    const { teleoperation } = scene;
    if (!teleoperation || !now) return;
    const [felt, met] = [force_on_hand(teleoperation, now), Math.hypot(...now.f_remote)];
    write(this.sentence, who_holds(teleoperation, now));
    this.sentence.dataset.held = String(now.link === "lost" || felt >= 0.5);
    write(this.hand, force_text(teleoperation, felt));
    write(this.machine, force_text(teleoperation, met));
    fill(this.hand_bar, felt / FULL_FORCE);
    fill(this.machine_bar, met / FULL_FORCE);
    this.set(this.values, "clutch", clutch_state(now));
    this.set(this.values, "distance hand to remote", apart_text(teleoperation, now) || "-");
    const link = link_text(now);
    this.set(this.values, "there and back", link.round_trip);
    this.set(this.values, "jitter", link.jitter);
    this.set(this.values, "packets lost", link.lost);
    this.set(this.values, "age of the newest packet", link.age);
    this.set(this.energies, "operator's port", energy_text(now.energy_leader));
    this.set(this.energies, "remote port", energy_text(now.energy_remote));
    this.set(this.energies, "dissipated", energy_text(now.dissipated));
    const { history } = this.store;
    if (history.length === 0) return;
    const to = Math.max(history.last("time_s"), PLOT_S);
    this.plot?.draw({ scene, history, range: { from: to - PLOT_S, to } });
  }

  private list(outputs: Map<string, HTMLElement>, names: string[]): HTMLElement {
    const rows = names.flatMap((name) => {
      const output = make("dd");
      outputs.set(name, output);
      return [make("dt", "", name), output];
    });
    return make("dl", "values", ...rows);
  }

  private set(outputs: Map<string, HTMLElement>, name: string, text: string): void {
    write(outputs.get(name)!, text);
  }
}

function energy_text(energy_J: number): string {
  return `${energy_J.toFixed(2)} J`;
}
