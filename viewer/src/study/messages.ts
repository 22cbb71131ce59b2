// Messages between the server of a study (`hapticgiant study run`) and its two pages. The server
// sends the whole state after each change.

export type Json = Record<string, unknown>;

export interface Answer {
  kind: "answer";
  id: number;
  problem: string | null; // null: done
}

export type ItemKind = "likert" | "slider" | "text";

export interface Item {
  name: string;
  kind: ItemKind;
  text: string;
  low: number;
  high: number;
  step: number;
  ends: [string, string] | []; // words at low and high, may be empty
}

export type Pair = [string, string]; // names of items

export interface Form {
  name: string;
  kind: "nasa_tlx" | "sus" | "own";
  about: string; // Markdown
  items: Item[];
  pairs: Pair[]; // of each: which one mattered more
}

export interface ParticipantState {
  kind: "state";
  title: string;
  code: string | null;
  draft: string; // differs between studies: what is kept of a form that is filled is theirs
  languages: string[];
  language: string;
  position: number | null;
  progress: number; // 0..1
  screen: "waiting" | "instruction" | "trial" | "break" | "form" | "end";
  markdown?: string; // of an instruction
  link?: string | null; // of the run, when the hand is a mouse
  task?: string; // Markdown of a trial
  is_practice?: boolean;
  rest_s?: number; // of a break, when sent
  form?: Form;
}

export type Phase =
  | "closed"
  | "participant"
  | "ready"
  | "moving"
  | "starting"
  | "running"
  | "ending"
  | "measuring"
  | "failed"
  | "complete";

export type Ability =
  | "begin"
  | "leave"
  | "start"
  | "end"
  | "abort"
  | "repeat"
  | "go_on"
  | "note"
  | "stop";

export interface Step {
  kind: "instruction" | "practice" | "trial" | "form" | "break";
  condition?: string | null;
  repetition?: number | null;
  form?: string | null;
  text?: string | null;
  is_done: boolean;
}

export interface Person {
  code: string;
  conditions: string[];
  status: "planned" | "begun" | "complete" | "withdrawn";
  done: number; // steps with files
  of: number;
}

export interface Run {
  link: string;
  mode: string;
  is_held: boolean;
  time_s: number | null;
  force_N: number | null;
  fault: string | null;
  events: { time_s: number; name: string }[];
  expected_events: string[];
}

export interface Measure {
  value: number | null;
  unit: string;
  why: string; // there is no value
}

export interface Last {
  condition: string;
  repetition: number;
  exit_code: number;
  excluded: string; // why; empty: it counts
  missing_events: string[];
  measures: Record<string, Measure>;
}

export interface OperatorState {
  kind: "state";
  title: string;
  people: "real" | "simulated";
  hand: "mouse" | "device" | "script";
  participants: Person[];
  next: string | null;
  participant: string | null;
  participant_page: { link: string; is_connected: boolean; language: string };
  steps: Step[];
  position: number | null;
  phase: Phase;
  problem: string | null;
  run: Run | null;
  last: Last | null;
  notes: { step: number | null; text: string }[];
  markers: { name: string; is_connected: boolean; count: number }[];
  can: Ability[];
}

export interface Live {
  kind: "live";
  run: Run | null;
}
