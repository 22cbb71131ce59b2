// The page of who leads a study.

import { token, watch_token } from "../data/token";
import { element, make, write } from "../page";
import { start_theme } from "../theme";
import { Actions, type Send } from "./actions";
import { DeviceView } from "./device_view";
import { show_last, show_markers, show_notes, show_people, show_steps } from "./lists";
import type { Live, OperatorState, Run } from "./messages";
import { hint_text, kind_text, phase_text } from "./operator_text";
import { StudyLink } from "./study_link";

const LOST =
  "No connection to the study server: what is shown is old. Trying again\u2026 " +
  "STOP and Esc still go to the run's own page, if it is there. After a restart of the study, open its new link.";
const NO_TOKEN = "Please open the whole link that the study program has printed: it has a secret in it.";

class OperatorPage {
  private state: OperatorState | null = null;
  private frame: HTMLIFrameElement | null = null;
  private frame_link = "";
  private readonly device = new DeviceView();
  private readonly link: StudyLink;
  private readonly actions: Actions;

  constructor() {
    this.link = new StudyLink("operator", {
      on_message: (message) => {
        if (message.kind === "state") this.take(message as unknown as OperatorState);
        else if (message.kind === "live") this.take_run((message as unknown as Live).run);
      },
      on_connection: (is_connected) => {
        document.body.dataset.connected = String(is_connected);
        write(element("connection"), is_connected ? "" : LOST);
        this.show_stop_note();
      },
    });
    this.actions = new Actions(this.send);
    element("stop").addEventListener("click", () => this.stop());
    const take_key = (event: KeyboardEvent): void => {
      if (event.key !== "Escape" || event.repeat) return;
      event.preventDefault();
      event.stopImmediatePropagation();
      this.stop();
    };
    addEventListener("keydown", take_key, { capture: true }); // before anything else takes it
    element<HTMLFormElement>("note-form").addEventListener("submit", (event) => {
      event.preventDefault();
      void this.add_note();
    });
    element("copy-link").addEventListener("click", () => void this.copy_link());
  }

  private readonly send: Send = async (command, content = {}) => {
    const outcome = await this.link.send(command, content);
    const problem =
      outcome.kind === "refused"
        ? outcome.problem
        : outcome.kind === "lost"
          ? `${command.replace("_", " ")}: no answer from the study server, it may not have been done.`
          : "";
    write(element("refusal"), problem);
    return outcome;
  };

  // By two ways: the run's page with its own connection to the control loop, and the study server.
  private stop(): void {
    this.frame?.contentWindow?.postMessage("emergency stop", "*");
    const answer = element("stop-answer");
    write(answer, "Emergency stop pressed.");
    void this.link.send("stop").then((outcome) => {
      if (outcome.kind === "done") write(answer, "Emergency stop pressed; the study server has taken it.");
      else if (outcome.kind === "refused") write(answer, `Emergency stop: ${outcome.problem}`);
      else write(answer, `Emergency stop: the study server cannot be reached${this.frame ? "; see the run's page" : ""}.`);
    });
  }

  private take(state: OperatorState): void {
    if (state.phase !== this.state?.phase && state.phase !== "running") write(element("stop-answer"), "");
    this.state = state;
    const { dataset } = document.body;
    dataset.phase = state.phase;
    dataset.fault = String(Boolean(state.run?.fault));
    dataset.position = String(state.position ?? "");
    document.title = `${state.participant ?? "Operator"}: ${state.title}`;
    write(element("title"), state.title);
    write(element("kind"), kind_text(state));
    element("kind").dataset.people = state.people;
    write(element("phase"), phase_text(state));
    write(element("hint"), hint_text(state));
    write(element("problem"), state.problem ?? "");
    this.show_participant_page(state);
    this.actions.show(state);
    show_steps(state); // first: what it takes is not left for the people
    show_people(state, (code) => void this.send("begin", { code }));
    show_last(state);
    show_notes(state);
    show_markers(state);
    this.take_run(state.run);
  }

  private take_run(run: Run | null): void {
    this.device.show(run);
    this.show_frame(run?.link ?? "");
  }

  // The run's own page: 3D, force, events, safety panel, stop.
  private show_frame(link: string): void {
    if (link === this.frame_link) return;
    this.frame_link = link;
    this.frame?.remove();
    this.frame = null;
    element("no-run").hidden = link !== "";
    if (link !== "") {
      this.frame = make("iframe");
      this.frame.title = "Page of the run";
      this.frame.allow = "xr-spatial-tracking"; // a headset
      this.frame.src = `${link}&show=trial`;
      element("view").append(this.frame);
    }
    this.show_stop_note();
  }

  private show_stop_note(): void {
    const is_connected = document.body.dataset.connected === "true";
    const note = is_connected ? "Esc" : this.frame ? "Esc, by the run's page only" : "cannot reach anything";
    write(element("stop-note"), note);
  }

  private show_participant_page({ participant_page }: OperatorState): void {
    const { is_connected, language, link } = participant_page;
    const line = element("participant-connection");
    line.dataset.connected = String(is_connected);
    write(line, `Participant's page: ${is_connected ? `connected, ${language}` : "not connected"}`);
    element("copy-link").hidden = is_connected || link === "";
  }

  private async copy_link(): Promise<void> {
    const link = this.state?.participant_page.link ?? "";
    const button = element("copy-link");
    const is_copied = await navigator.clipboard?.writeText(link).then(
      () => true,
      () => false,
    );
    write(button, is_copied ? "Copied" : link);
  }

  private async add_note(): Promise<void> {
    const input = element<HTMLInputElement>("note");
    const text = input.value.trim();
    if (text === "") return;
    const outcome = await this.send("note", { text });
    if (outcome.kind === "done" && input.value.trim() === text) input.value = "";
  }
}

watch_token();
start_theme();
new OperatorPage();
if (token() === "") write(element("connection"), NO_TOKEN);
