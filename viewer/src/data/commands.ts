// Commands to the program and their answers. What is set many times in a row (a slider) goes out at
// most ten times a second; the last value always goes.

import type { Answer, Command } from "../messages";

export type CommandName = Command["command"];

const LEAST_GAP_MS = 100;

export interface Refusal {
  command: CommandName | "message"; // message: one that could not be read
  name: string;
  reason: string;
}

export class Commands {
  private next_id = 1;
  private readonly open = new Map<number, Command>();
  private readonly waiting = new Map<string, number | null>(); // by setting in its gap; null: none

  constructor(
    private readonly send_message: (command: Command) => boolean,
    private readonly on_refusal: (refusal: Refusal) => void,
  ) {}

  send(command: CommandName, name = "", value = 0): void {
    const message: Command = { type: "command", id: this.next_id++, command, name, value };
    if (this.send_message(message)) this.open.set(message.id, message);
    else this.on_refusal({ command, name, reason: "not connected" });
  }

  // Sets the setting `name`, not too often.
  set(name: string, value: number): void {
    if (this.waiting.has(name)) {
      this.waiting.set(name, value);
      return;
    }
    this.send("set", name, value);
    this.waiting.set(name, null);
    setTimeout(() => this.end_gap(name), LEAST_GAP_MS);
  }

  take(answer: Answer): void {
    const command = this.open.get(answer.id);
    this.open.delete(answer.id);
    if (answer.is_accepted) return;
    const { command: kind, name } = command ?? { command: "message" as const, name: "" };
    this.on_refusal({ command: kind, name, reason: answer.reason });
  }

  forget(): void {
    this.open.clear();
  }

  private end_gap(name: string): void {
    const value = this.waiting.get(name) ?? null;
    this.waiting.delete(name);
    if (value !== null) this.set(name, value);
  }
}
