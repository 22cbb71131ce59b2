// The WebSocket to the server of a study: states come, commands go and are answered. Reconnects
// alone.

import { protocols } from "../data/token";
import type { Answer, Json } from "./messages";

const RETRY_MS = 1000;
const PATIENCE_MS = 15_000; // for an answer; then the connection is taken for dead

export type Outcome =
  | { kind: "done" }
  | { kind: "refused"; problem: string }
  | { kind: "lost" }; // it may have been done

interface Receiver {
  on_message(message: Json & { kind: string }): void; // all but answers
  on_connection(is_connected: boolean): void;
}

interface Waiting {
  resolve(outcome: Outcome): void;
  timer: number;
}

export class StudyLink {
  private socket: WebSocket | null = null;
  private next_id = 1;
  private readonly waiting = new Map<number, Waiting>();

  constructor(
    private readonly page: "operator" | "participant",
    private readonly receiver: Receiver,
  ) {
    addEventListener("offline", () => this.drop());
    this.open();
  }

  get is_connected(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  send(command: string, content: Json = {}): Promise<Outcome> {
    const { socket } = this;
    if (!socket || !this.is_connected) return Promise.resolve({ kind: "lost" });
    const id = this.next_id++;
    return new Promise((resolve) => {
      const timer = window.setTimeout(() => this.drop(), PATIENCE_MS);
      this.waiting.set(id, { resolve, timer });
      socket.send(JSON.stringify({ ...content, id, command }));
    });
  }

  private open(): void {
    const address = `${location.origin.replace(/^http/, "ws")}/ws/${this.page}`;
    const socket = new WebSocket(address, protocols("hapticgiant-study"));
    this.socket = socket;
    socket.onopen = () => this.receiver.on_connection(true);
    socket.onmessage = ({ data }) => this.take(String(data));
    socket.onclose = () => {
      if (this.socket === socket) this.lose();
    };
  }

  // A connection that is dead may take minutes to close.
  private drop(): void {
    if (!this.is_connected) return;
    this.socket!.close();
    this.lose();
  }

  private lose(): void {
    this.socket = null;
    for (const { resolve, timer } of this.waiting.values()) {
      clearTimeout(timer);
      resolve({ kind: "lost" });
    }
    this.waiting.clear();
    this.receiver.on_connection(false);
    setTimeout(() => this.open(), RETRY_MS);
  }

  private take(data: string): void {
    const message = JSON.parse(data) as Json & { kind: string };
    if (message.kind !== "answer") return this.receiver.on_message(message);
    const { id, problem } = message as unknown as Answer;
    const waiting = this.waiting.get(id);
    if (!waiting) return;
    this.waiting.delete(id);
    clearTimeout(waiting.timer);
    waiting.resolve(problem === null ? { kind: "done" } : { kind: "refused", problem });
  }
}
