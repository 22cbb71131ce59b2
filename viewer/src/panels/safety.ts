// The operator's panel of a simulated device, and what stops it: state, cause, release.

import type { Commands } from "../data/commands";
import type { Frame, Safety, Scene } from "../messages";
import { make, make_button, make_check_box, write } from "../page";
import { presser_text } from "../stop_button";

type Switch = "operator_enable" | "override_key" | "person_in_field";

const SWITCHES: readonly [Switch, string, string][] = [
  ["operator_enable", "Enabling switch held", "While this page is open and seen. Let go: braked, then drives off"],
  ["override_key", "Override key", "May move slowly while the handle is not held, as long as this page is open and seen"],
  ["person_in_field", "Person in the field", "Of the scanner, besides the user"],
];

const REQUESTS = [
  ["reset", "Reset", "After a fault, once its cause is gone"],
  ["arm", "Arm", "Drives on, brakes open, the device is held"],
  ["run", "Run", "By hand: the handle is held"],
  ["run_alone", "Run alone", "With the override key, slowly, handle not held"],
  ["hold", "Hold", "Braked, then held under power"],
] as const;
type Request = (typeof REQUESTS)[number][0];

// What leads on from here, the first step of a way back to running.
const NEXT: Partial<Record<Frame["mode"], Request>> = { fault: "reset", ready: "arm", armed: "run" };

const STOP_TEXT: Record<Safety["stop"], string> = {
  none: "",
  SS2: "braked, then drives off",
  SS1: "braked, then drives off",
  STO: "drives off and brakes closed at once",
};

export class SafetyPanel {
  private readonly mode = make("output", "large");
  private readonly how = make("p");
  private readonly cause = make("p", "safety");
  private readonly release = make("p");
  private readonly warning = make("p");
  private readonly stop: HTMLButtonElement;
  private readonly boxes = new Map<Switch, HTMLLabelElement>();
  private readonly panel = make("div", "safety-panel");
  private readonly requests = make("div", "buttons");
  private readonly by_request = new Map<Request, HTMLButtonElement>();
  private readonly stopping = make("p", "quiet");
  private readonly question = make("p");
  private readonly answers = make("div", "buttons safety-answers");
  private pressed_by: number[] = [];
  private is_pressed = false;
  private is_asking = false; // whether to release a stop that another page has pressed

  constructor(
    section: HTMLElement,
    private readonly commands: Commands,
    private readonly own_page: () => number,
  ) {
    const flip = (name: Switch, is_on: boolean): void => {
      commands.send("panel", name, is_on ? 1 : 0);
    };
    this.stop = make_button("Emergency stop", "Press it, and press it again to pull it out", () =>
      this.press_or_release(),
    );
    this.stop.className = "emergency-stop";
    this.answers.append(
      make_button("Release it", "The stop of another page", () => {
        this.pull_out(this.pressed_by[0] ?? 0);
      }),
      make_button("Leave it", "It stays pressed", () => this.show_question(false)),
    );
    this.show_question(false);
    for (const [name, text, title] of SWITCHES) {
      const box = make_check_box(text, name === "operator_enable", (is_on) => flip(name, is_on));
      box.title = title;
      this.boxes.set(name, box);
      this.panel.append(box);
    }
    for (const [name, text, title] of REQUESTS) {
      const button = make_button(text, title, () => commands.send("mode", name));
      this.by_request.set(name, button);
      this.requests.append(button);
    }
    section.append(
      make("h2", "", "Safety"),
      this.stop, // where no text moves it
      this.question,
      this.answers,
      this.mode,
      make("div", "safety-texts", this.how, this.cause, this.release, this.warning),
      this.panel,
      this.requests,
      this.stopping,
      make("p", "quiet", "Simulated. Nothing here is a certified safety function."),
    );
  }

  load(scene: Scene): void {
    this.stop.hidden = !scene.commands.includes("emergency_stop");
    this.panel.hidden = !scene.commands.includes("panel");
    this.requests.hidden = !scene.commands.includes("mode");
    write(this.stopping, scene.stopping);
  }

  show({ mode, safety, run_state }: Frame): void {
    write(this.mode, safety.is_autonomous ? `${mode}, handle not held` : mode);
    // after a fault the drives go off in any case
    const is_held = safety.stop === "SS2" && safety.fault === 0;
    write(this.how, is_held ? "braked, then held" : STOP_TEXT[safety.stop]);
    write(this.cause, safety.cause);
    this.cause.dataset.mode = mode;
    write(this.release, safety.release === "" ? "" : `Release: ${safety.release}.`);
    write(this.warning, safety.warning === "" ? "" : `Near: ${safety.warning}`);
    this.is_pressed = safety.emergency_stop;
    this.pressed_by = safety.stop_pressed_by;
    if (!this.is_pressed) this.show_question(false);
    if (this.is_asking) this.show_question(true); // it may be that of another page by now
    write(this.stop, this.is_pressed ? "Emergency stop: pull it out" : "Emergency stop");
    this.stop.setAttribute("aria-pressed", String(this.is_pressed));
    for (const [name, box] of this.boxes) {
      box.querySelector("input")!.checked = safety[name];
    }
    this.stop.dataset.next = String(this.is_pressed);
    const next = this.is_pressed || run_state.is_over ? undefined : NEXT[mode];
    for (const [name, button] of this.by_request) button.dataset.next = String(name === next);
  }

  // A stop of another page is released by its number, after a question.
  private press_or_release(): void {
    if (!this.is_pressed) this.commands.send("emergency_stop");
    else if (this.pressed_by.includes(this.own_page())) this.pull_out(this.own_page());
    else this.show_question(true);
  }

  private pull_out(page: number): void {
    this.show_question(false);
    this.commands.send("release_stop", "", page);
  }

  private show_question(is_asking: boolean): void {
    this.is_asking = is_asking;
    this.question.hidden = this.answers.hidden = !is_asking;
    const by = presser_text(this.pressed_by[0] ?? 0, this.own_page());
    write(this.question, `The stop was pressed by ${by}. Release it?`);
  }
}
