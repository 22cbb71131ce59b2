// The bar at the top: scenario, time, state, and how the scene is seen.

import type { CommandName } from "./data/commands";
import type { Link } from "./data/freshness";
import type { Store } from "./data/store";
import { hand_words } from "./hand/hand_words";
import { type Icon, icon } from "./icons";
import type { Frame, Scene } from "./messages";
import { element, is_typing, make, make_button, write } from "./page";
import { fill_choice } from "./panels/choices";
import type { PlotDrawer } from "./plots/drawer";
import { heading_text, mode_text, note_text, time_text } from "./text";
import { choose_theme, current_theme, on_theme_change } from "./theme";

const RUN_SPEEDS = [0.1, 0.25, 0.5, 1];
const RECORDING_SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8];
const STEP_CYCLES = 10; // of a run; a recording steps by one frame

function icon_button(name: Icon, title: string, on_click: () => void): HTMLButtonElement {
  const button = make_button("", title, on_click);
  button.setAttribute("aria-label", title);
  button.className = "icon-button";
  button.replaceChildren(icon(name));
  return button;
}

export class Toolbar {
  private readonly scenario = element<HTMLSelectElement>("scenario");
  private readonly speed = make("select");
  private readonly pause: HTMLButtonElement;
  private readonly by_command: [CommandName[], HTMLButtonElement | HTMLSelectElement][];
  private readonly way_out: HTMLButtonElement;
  private is_paused = false;

  constructor(
    private readonly store: Store,
    show_safety: () => void,
  ) {
    this.way_out = make_button("what now?", "Cause, release and the way back to running", show_safety);
    this.way_out.className = "small";
    element("fault").append(this.way_out);
    const send = (command: CommandName, value = 0): void => store.commands.send(command, "", value);
    this.pause = icon_button("pause", "Pause (P)", () => this.toggle_pause());
    this.pause.id = "pause";
    const step = icon_button("step", "One step (.)", () => send("step", this.step_size));
    const restart = icon_button("restart", "From the start (R)", () => send("restart"));
    const stop = icon_button("stop", "Controlled stop", () => send("stop"));
    this.speed.id = "speed";
    this.speed.title = "Speed of time";
    this.speed.setAttribute("aria-label", this.speed.title);
    this.speed.addEventListener("change", () => send("speed", Number(this.speed.value)));
    element("transport").append(this.pause, step, restart, stop, this.speed);
    this.by_command = [
      [["pause", "resume"], this.pause],
      [["step"], step],
      [["restart"], restart],
      [["stop"], stop],
      [["speed"], this.speed],
      [["scenario"], this.scenario],
    ];
    this.scenario.addEventListener("change", () => {
      store.commands.send("scenario", this.scenario.value);
    });
    addEventListener("keydown", (event) => this.take_key(event));
  }

  load(scene: Scene): void {
    const heading = heading_text(scene);
    document.title = heading;
    write(element("title"), heading);
    const { scenario, scenarios } = scene.choices;
    fill_choice(this.scenario, scenarios, scenario);
    this.scenario.selectedOptions[0]!.text = this.scenario.title = heading;
    const speeds = scene.source === "recording" ? RECORDING_SPEEDS : RUN_SPEEDS;
    this.speed.replaceChildren(...speeds.map((s) => new Option(`${s} \u00d7`, String(s))));
    for (const [commands, part] of this.by_command) {
      part.disabled = !commands.some((command) => scene.commands.includes(command));
      if (part.disabled && scene.refusal !== "") part.title = scene.refusal;
    }
    write(element("story"), scene.description);
  }

  // Puts back a choice that was refused.
  refuse(): void {
    if (this.store.scene) this.scenario.value = this.store.scene.choices.scenario;
    if (this.store.frame) this.show_speed(this.store.frame.run_state.speed);
  }

  show_mode(frame: Frame | null, link: Link): void {
    const mode = element("mode");
    const { text, kind } = mode_text(frame, link);
    write(mode, text);
    mode.dataset.mode = kind;
    const title = link === "open" && frame ? frame.mode_text : "";
    if (mode.title !== title) mode.title = title;
  }

  show(frame: Frame): void {
    const { run_state } = frame;
    write(element("time"), time_text(frame.time_s));
    this.show_note(frame);
    if (this.is_paused !== run_state.is_paused) this.show_pause(run_state.is_paused);
    if (document.activeElement !== this.speed) this.show_speed(run_state.speed);
  }

  private show_note(frame: Frame): void {
    const is_for_hand = document.body.dataset.show === "hand" && frame.mode === "fault";
    const text = is_for_hand ? hand_words().stopped : note_text(frame, this.store.scene?.source === "run");
    const note = element("fault");
    write(element("fault-text"), text);
    note.hidden = text === "";
    note.dataset.mode = frame.mode;
    this.way_out.hidden = frame.mode !== "fault" || frame.run_state.is_over;
  }

  private get step_size(): number {
    return this.store.scene?.source === "recording" ? 1 : STEP_CYCLES;
  }

  private toggle_pause(): void {
    const is_paused = this.store.frame?.run_state.is_paused ?? false;
    this.store.commands.send(is_paused ? "resume" : "pause");
  }

  private show_pause(is_paused: boolean): void {
    this.is_paused = is_paused;
    this.pause.replaceChildren(icon(is_paused ? "play" : "pause"));
    this.pause.title = is_paused ? "Continue (P)" : "Pause (P)";
    this.pause.setAttribute("aria-label", this.pause.title);
    this.pause.setAttribute("aria-pressed", String(is_paused));
  }

  private show_speed(speed: number): void {
    const text = String(speed);
    if (this.speed.value === text) return;
    if (![...this.speed.options].some(({ value }) => value === text)) {
      this.speed.add(new Option(`${Number(speed.toPrecision(3))} \u00d7`, text));
    }
    this.speed.value = text;
  }

  private take_key(event: KeyboardEvent): void {
    if (is_typing(event) || event.ctrlKey || event.metaKey) return;
    if (event.repeat && event.key !== ".") return;
    if (event.key === "p") this.toggle_pause();
    else if (event.key === ".") this.store.commands.send("step", "", this.step_size);
    else if (event.key === "r") this.store.commands.send("restart");
  }
}

// Buttons at the right that every picture has: plots, theme, keys.
export function build_page_tools(drawer: PlotDrawer, toggle_keys: () => void): void {
  const plots = icon_button("plots", "Plots", () => {
    plots.setAttribute("aria-pressed", String(drawer.toggle()));
  });
  plots.setAttribute("aria-pressed", String(drawer.is_shown));
  plots.id = "show-plots";
  const theme = icon_button("dark", "Light or dark", () => {
    choose_theme(current_theme().is_dark ? "light" : "dark");
  });
  theme.id = "theme";
  const paint = (): void => theme.replaceChildren(icon(current_theme().is_dark ? "light" : "dark"));
  on_theme_change(paint);
  paint();
  const keys = icon_button("keys", "Keys (?)", toggle_keys);
  keys.id = "show-keys";
  element("view-tools").append(plots, theme, keys);
}
