// The page of a participant of a study: one screen after the other, as the server says.

import { token, watch_token } from "../data/token";
import { element, make, make_button, write } from "../page";
import { start_theme } from "../theme";
import { forget_other_drafts, owner_of } from "./answers";
import { form_screen } from "./form_screen";
import type { ParticipantState } from "./messages";
import {
  break_screen,
  end_screen,
  instruction_screen,
  trial_screen,
  waiting_screen,
  type Desk,
  type Screen,
} from "./screens";
import { StudyLink } from "./study_link";
import { language_name, words_of, type Words } from "./words";

const PLANNED: ParticipantState = {
  kind: "state",
  title: "",
  code: null,
  draft: "",
  languages: [],
  language: navigator.language.slice(0, 2) === "de" ? "de" : "en",
  position: null,
  progress: 0,
  screen: "waiting",
};

// What makes it another screen, to be built again.
function identity(state: ParticipantState): string {
  const { code, position, screen, language, form, markdown, task, is_practice } = state;
  const languages = screen === "waiting" ? state.languages : [];
  return JSON.stringify({ code, position, screen, language, form, markdown, task, is_practice, languages });
}

class ParticipantPage {
  private state = PLANNED;
  private screen: Screen | null = null;
  private shown = "";
  private has_been_connected = false;
  private readonly link: StudyLink;
  private readonly main = element("screen");
  private readonly problem = make("p", "problem alert");

  constructor() {
    this.problem.setAttribute("role", "alert");
    this.take(PLANNED);
    this.link = new StudyLink("participant", {
      on_message: (message) => {
        if (message.kind === "state") this.take(message as unknown as ParticipantState);
      },
      on_connection: (is_connected) => this.show_connection(is_connected),
    });
  }

  private get words(): Words {
    return words_of(this.state.language);
  }

  private take(state: ParticipantState): void {
    const is_other_place =
      state.screen !== this.state.screen ||
      state.position !== this.state.position ||
      state.code !== this.state.code;
    this.state = state;
    if (state.code !== null && state.position !== null) forget_other_drafts(owner_of(state), state.position);
    document.documentElement.lang = state.language;
    document.title = state.title || "Study";
    write(element("title"), state.title);
    const { dataset } = document.body;
    dataset.screen = state.screen;
    dataset.position = String(state.position ?? "");
    dataset.code = state.code ?? "";
    this.show_progress();
    const wanted = identity(state);
    if (wanted === this.shown) return this.screen?.update?.(state);
    const is_new = is_other_place && this.shown !== "";
    this.shown = wanted;
    this.build(is_new);
  }

  private build(is_other_place: boolean): void {
    this.screen?.close?.();
    const { state, words } = this;
    const focused = document.activeElement?.id ?? "";
    write(this.problem, "");
    write(element("news"), "");
    element("languages").replaceChildren(...this.language_buttons("top"));
    element("languages").setAttribute("aria-label", words.language);
    element("languages").hidden = state.languages.length < 2 || state.code === null;
    this.screen = this.screen_of(state);
    this.main.replaceChildren(this.screen.root, this.problem);
    if (is_other_place) {
      scrollTo(0, 0);
      this.screen.heading.focus();
    } else document.getElementById(focused)?.focus(); // a choice of language stays where it is
  }

  private screen_of(state: ParticipantState): Screen {
    const desk: Desk = {
      words: this.words,
      go_on: () => this.go_on(),
      say: (news) => write(element("news"), news),
    };
    if (state.screen === "instruction") return instruction_screen(desk, state);
    if (state.screen === "trial") return trial_screen(desk, state);
    if (state.screen === "break") return break_screen(desk, state);
    if (state.screen === "end") return end_screen(desk);
    if (state.screen === "form" && state.form) {
      const { position } = state;
      return form_screen({ ...desk, submit: (answers) => this.link.send("answers", { position, ...answers }) }, state);
    }
    return waiting_screen(desk, state.code === null ? this.language_group() : null);
  }

  private language_group(): HTMLElement | null {
    if (this.state.languages.length < 2) return null;
    const group = make("div", "languages", ...this.language_buttons("first"));
    group.setAttribute("role", "group");
    group.setAttribute("aria-label", this.words.language);
    return group;
  }

  private language_buttons(place: string): HTMLElement[] {
    return this.state.languages.map((language) => {
      const button = make_button(language_name(language), "", () => {
        void this.show_problem(this.link.send("language", { language }));
      });
      button.removeAttribute("title");
      button.id = `language-${language}-${place}`;
      button.lang = language;
      button.setAttribute("aria-pressed", String(language === this.state.language));
      return button;
    });
  }

  private go_on(): Promise<void> {
    return this.show_problem(this.link.send("go_on", { position: this.state.position }));
  }

  private async show_problem(sent: ReturnType<StudyLink["send"]>): Promise<void> {
    const outcome = await sent;
    if (outcome.kind === "done") return write(this.problem, "");
    write(this.problem, outcome.kind === "lost" ? this.words.not_done : outcome.problem);
  }

  private show_progress(): void {
    const bar = element<HTMLProgressElement>("progress");
    bar.hidden = this.state.code === null || this.state.screen === "end";
    bar.value = this.state.progress;
    bar.setAttribute("aria-label", this.words.progress);
  }

  private show_connection(is_connected: boolean): void {
    document.body.dataset.connected = String(is_connected);
    const line = element("connection");
    const is_back = is_connected && this.has_been_connected;
    line.dataset.state = is_connected ? "open" : "lost";
    write(line, is_connected ? (is_back ? this.words.again : "") : this.words.lost);
    if (is_connected) this.has_been_connected = true;
  }
}

watch_token();
start_theme();
new ParticipantPage();
if (token() === "") {
  const line = element("connection");
  line.dataset.state = "lost";
  write(line, words_of(PLANNED.language).no_token);
}
