// The WebSocket to the program: passes messages on, reconnects automatically.

import type { Command, Hand, Hold } from "../messages";
import { type Message, read_message } from "./read_message";
import { protocols } from "./token";

const RETRY_MS = 1000;

interface Receiver {
  on_message(message: Message): void;
  on_refused(reason: string): void; // of a message that cannot be read
  on_state(is_connected: boolean): void;
}

export class Connection {
  private socket: WebSocket | null = null;

  constructor(private readonly receiver: Receiver) {
    this.open();
  }

  get is_connected(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  // False while there is no connection.
  send(message: Hand | Hold | Command): boolean {
    if (!this.is_connected) return false;
    this.socket!.send(JSON.stringify(message));
    return true;
  }

  private open(): void {
    const socket = new WebSocket(`ws://${location.host}/ws`, protocols());
    this.socket = socket;
    socket.onopen = () => this.receiver.on_state(true);
    socket.onmessage = ({ data }) => {
      const message = read_message(data);
      if (typeof message === "string") this.receiver.on_refused(message);
      else this.receiver.on_message(message);
    };
    socket.onclose = () => {
      this.receiver.on_state(false);
      setTimeout(() => this.open(), RETRY_MS);
    };
  }
}
