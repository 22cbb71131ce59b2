// Screens of the participant's page that ask nothing.

import { make, make_button, write } from "../page";
import { show_markdown } from "./markdown";
import type { ParticipantState } from "./messages";
import type { Words } from "./words";

export interface Screen {
  root: HTMLElement;
  heading: HTMLElement; // gets the focus
  update?(state: ParticipantState): void; // of the same screen
  close?(): void;
}

export interface Desk {
  words: Words;
  go_on(): Promise<void>;
  say(news: string): void; // to who does not see it
}

export function heading_of(text: string): HTMLElement {
  const heading = make("h1", "", text);
  heading.tabIndex = -1;
  return heading;
}

export function main_button(text: string, on_click: () => void): HTMLButtonElement {
  const button = make_button(text, "", on_click);
  button.removeAttribute("title");
  button.className = "main";
  return button;
}

function prose(markdown: string): HTMLElement {
  const part = make("div", "prose");
  show_markdown(part, markdown);
  return part;
}

export function waiting_screen({ words }: Desk, languages: HTMLElement | null): Screen {
  const heading = heading_of(words.waiting);
  const text = make("p", "lead", languages ? words.waiting_first : words.waiting_text);
  const root = make("div", "middle", heading, text, ...(languages ? [languages] : []));
  return { root, heading };
}

export function end_screen({ words }: Desk): Screen {
  const heading = heading_of(words.end);
  return { root: make("div", "middle", heading, make("p", "lead", words.end_text)), heading };
}

export function instruction_screen({ words, go_on }: Desk, state: ParticipantState): Screen {
  const heading = heading_of(words.instruction);
  const go = main_button(words.continue, () => void go_on());
  return { root: make("div", "page", heading, prose(state.markdown ?? ""), go), heading };
}

// The run's own page: only the handle, and its stop.
export function hand_link(link: string, language: string): string {
  return `${link}&show=hand&language=${language}`;
}

export function trial_screen({ words }: Desk, first: ParticipantState): Screen {
  const heading = heading_of(first.is_practice ? words.practice : words.trial);
  const task = prose(first.task ?? "");
  const how = make("p", "lead");
  const root = make("div", "trial", heading, task, how);
  let frame: HTMLIFrameElement | null = null;
  let shown: string | null = null;
  const update = ({ link, language }: ParticipantState): void => {
    const wanted = link ?? null;
    write(how, wanted === null ? words.device : words.mouse);
    root.dataset.hand = wanted === null ? "device" : "mouse";
    if (wanted === shown) return;
    shown = wanted;
    frame?.remove();
    frame = null;
    if (wanted === null) return;
    frame = make("iframe");
    frame.title = words.picture;
    frame.allow = "xr-spatial-tracking"; // a headset
    frame.src = hand_link(wanted, language);
    root.append(frame);
  };
  const stop = (event: KeyboardEvent): void => {
    if (event.key !== "Escape" || event.repeat || !frame) return;
    event.preventDefault();
    frame.contentWindow?.postMessage("emergency stop", "*");
  };
  addEventListener("keydown", stop, { capture: true });
  update(first);
  return { root, heading, update, close: () => removeEventListener("keydown", stop, { capture: true }) };
}

const TICK_MS = 250;

// 95 -> 1:35
export function clock_text(seconds: number): string {
  const whole = Math.max(0, Math.ceil(seconds));
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}

export function break_screen({ words, go_on, say }: Desk, first: ParticipantState): Screen {
  const heading = heading_of(words.break);
  const clock = make("p", "clock");
  clock.setAttribute("role", "timer");
  const text = make("p", "lead");
  const go = main_button(words.continue, () => void go_on());
  let end_ms = 0;
  let said = Infinity; // minutes that were said last
  const show = (): void => {
    const left_s = (end_ms - performance.now()) / 1000;
    const is_over = left_s <= 0;
    write(clock, clock_text(left_s));
    write(text, is_over ? words.break_over : words.break_text);
    clock.dataset.over = String(is_over);
    go.hidden = !is_over;
    const minutes = Math.max(0, Math.ceil(left_s / 60));
    if (minutes >= said) return;
    if (minutes === 0) say(words.break_over);
    else if (said !== Infinity) say(words.minutes_left(minutes));
    said = minutes;
  };
  const update = ({ rest_s }: ParticipantState): void => {
    end_ms = performance.now() + 1000 * (rest_s ?? 0);
    show();
  };
  update(first);
  const timer = setInterval(show, TICK_MS);
  const root = make("div", "middle", heading, clock, text, go);
  return { root, heading, update, close: () => clearInterval(timer) };
}
