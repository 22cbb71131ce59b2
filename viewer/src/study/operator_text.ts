// What the operator's page says of the state of a study.

import type { OperatorState, Person, Phase, Run, Step } from "./messages";

const KINDS: Record<Step["kind"], string> = {
  instruction: "Instruction",
  practice: "Practice",
  trial: "Trial",
  form: "Form",
  break: "Break",
};

// Trial 2, door
export function step_text({ kind, condition, repetition, form }: Step): string {
  const is_played = kind === "trial" || kind === "practice";
  const what = is_played && repetition ? `${KINDS[kind]} ${repetition}` : KINDS[kind];
  return [what, kind === "form" ? form : "", condition].filter(Boolean).join(", ");
}

const DOES: Partial<Record<Step["kind"], string>> = {
  instruction: "reads",
  form: "answers",
  break: "rests",
};

const PHASES: Record<Exclude<Phase, "closed" | "participant" | "complete">, string> = {
  ready: "Ready to start",
  moving: "The device moves to the start",
  starting: "The run starts",
  running: "Running",
  ending: "The run ends",
  measuring: "The recording is measured",
  failed: "No result",
};

function present_step({ steps, position }: OperatorState): Step | null {
  return (position === null ? null : steps[position]) ?? null;
}

export function phase_text(state: OperatorState): string {
  const { phase, participant } = state;
  const step = present_step(state);
  if (phase === "closed") return state.next ? `Next: ${state.next}` : "No participant is left";
  if (phase === "complete") return `${participant ?? "The session"} is complete`;
  if (phase === "participant") return `${participant} ${(step && DOES[step.kind]) ?? "is at the page"}`;
  if (state.run?.fault) return `Stopped: ${state.run.fault}`;
  return PHASES[phase];
}

export function hint_text(state: OperatorState): string {
  const step = present_step(state);
  const where = step
    ? `${state.participant}, step ${state.position! + 1} of ${state.steps.length}: ${step_text(step)}`
    : "";
  const about: Partial<Record<Phase, string>> = {
    closed: state.next ? "No session is open." : "All sessions of the plan are done.",
    moving: "Keep clear: the device moves.",
    failed: "Start plays it again.",
    running: state.run?.fault
      ? "Throw it away and play it again; or release, Reset, Arm and Run in the tab Safety below: then it continues, with exit code 3"
      : "",
    complete: "Close the session to go on with the next participant.",
  };
  return [where, about[state.phase] ?? ""].filter(Boolean).join(". ");
}

const STATUS: Record<Person["status"], string> = {
  planned: "planned",
  begun: "begun",
  complete: "complete",
  withdrawn: "withdrawn",
};

export function person_text({ status, done, of }: Person): string {
  return status === "begun" ? `${STATUS.begun}, ${done} of ${of}` : STATUS[status];
}

export function kind_text({ people, hand }: OperatorState): string {
  const hands = { mouse: "handle by mouse", device: "handle of a device", script: "scripted hand" };
  return `${people === "real" ? "Real people" : "Simulated people"}, ${hands[hand]}`;
}

interface EventRow {
  name: string;
  time_s: number | null; // null: expected, has not happened
  is_expected: boolean;
}

// Expected events in their order, each with the first happening that is not used up; then the others.
export function event_rows({ events, expected_events }: Pick<Run, "events" | "expected_events">): EventRow[] {
  const left = [...events];
  const expected = expected_events.map((name): EventRow => {
    const at = left.findIndex((event) => event.name === name);
    const found = at < 0 ? null : left.splice(at, 1)[0]!;
    return { name, time_s: found?.time_s ?? null, is_expected: true };
  });
  const others = left.map((event): EventRow => ({ ...event, is_expected: false }));
  return [...expected, ...others];
}

export function number_text(value: number | null): string {
  if (value === null || !Number.isFinite(value)) return "no value";
  const size = Math.abs(value);
  if (size !== 0 && (size < 0.001 || size >= 1e6)) return value.toExponential(2);
  return String(Number(value.toPrecision(4)));
}

// Events of the task that a trial lacks.
export function missing_text(names: string[]): string {
  return `${names.length === 1 ? "Missing event" : "Missing events"}: ${names.join(", ")}`;
}

// What ended it: exit codes of `hapticgiant run`.
export function exit_text(exit_code: number): string {
  if (exit_code === 0) return "ended well";
  const what = { 1: "an event is missing or a limit was exceeded", 3: "a fault stopped the device" }[exit_code];
  return what ? `${what} (exit code ${exit_code})` : `exit code ${exit_code}`;
}
