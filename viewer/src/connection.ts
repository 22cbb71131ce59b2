// The WebSocket to the program: hands messages on, reconnects by itself.

import type { Event, Frame, Hand } from "./messages";
import { RateMeter } from "./rate_meter";

const RETRY_MS = 1000;

export interface Listener {
  on_frame(frame: Frame): void;
  on_event(event: Event): void;
  on_state(is_connected: boolean): void;
}

export class Connection {
  private socket: WebSocket | null = null;
  private readonly rate = new RateMeter();

  constructor(private readonly listener: Listener) {
    this.open();
  }

  get is_connected(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  frames_per_second(): number {
    return this.rate.per_second(performance.now() / 1000);
  }

  send(hand: Hand): void {
    if (this.is_connected) this.socket?.send(JSON.stringify(hand));
  }

  private open(): void {
    const token = new URLSearchParams(location.search).get("token");
    const query = token ? `?token=${encodeURIComponent(token)}` : "";
    const socket = new WebSocket(`ws://${location.host}/ws${query}`);
    this.socket = socket;
    socket.onopen = () => this.listener.on_state(true);
    socket.onmessage = (message) => this.take(JSON.parse(message.data as string));
    socket.onclose = () => {
      this.listener.on_state(false);
      setTimeout(() => this.open(), RETRY_MS);
    };
  }

  private take(message: Frame | Event): void {
    if (message.type === "frame") {
      this.rate.tick(performance.now() / 1000);
      this.listener.on_frame(message);
    } else {
      this.listener.on_event(message);
    }
  }
}
