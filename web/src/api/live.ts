// SPDX-License-Identifier: Apache-2.0
import { parsePacket, type Packet } from './packet';
import type { PartName } from './types';

export interface LiveHandlers {
  /** Draws; the server sends the next packet once the promise is done. */
  packet(packet: Packet): Promise<void>;
  connected(): void;
  /** @param seconds until the next attempt */
  disconnected(seconds: number): void;
  fault(message: string): void;
}

const firstDelay = 0.5;
const longestDelay = 8;

/** The newest frame, one at a time: what comes while the page draws is dropped by the server. */
export class LiveConnection {
  private socket: WebSocket | null = null;
  private delay = firstDelay;
  private timer = 0;
  private paused = false;
  private owing = false; // a packet is drawn that "ready" was not said for

  constructor(
    private readonly handlers: LiveHandlers,
    private wanted: readonly PartName[],
    private step: number,
  ) {
    this.open();
  }

  want(wanted: readonly PartName[], step: number): void {
    this.wanted = wanted;
    this.step = step;
    this.send({ type: 'want', with: wanted, step });
  }

  /** Holds the picture; the server goes on and counts what is dropped. */
  setPaused(paused: boolean): void {
    this.paused = paused;
    if (!paused && this.owing) this.ready();
  }

  /** A new connection: over the old one, whose other end may be gone, nothing may come any more. */
  renew(): void {
    window.clearTimeout(this.timer);
    const old = this.socket;
    this.open();
    if (!old) return;
    old.onmessage = null;
    old.close();
  }

  private open(): void {
    const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
    const socket = new WebSocket(`${scheme}://${location.host}/api/live`);
    this.socket = socket;
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.delay = firstDelay;
      this.handlers.connected();
      this.want(this.wanted, this.step);
      this.owing = true;
      if (!this.paused) this.ready();
    };
    socket.onmessage = (event: MessageEvent<unknown>) => void this.take(event.data);
    socket.onclose = () => this.reconnect(socket);
  }

  private reconnect(socket: WebSocket): void {
    if (this.socket !== socket) return; // closed by us
    this.handlers.disconnected(this.delay);
    this.timer = window.setTimeout(() => this.open(), this.delay * 1000);
    this.delay = Math.min(2 * this.delay, longestDelay);
  }

  private async take(data: unknown): Promise<void> {
    if (!(data instanceof ArrayBuffer)) return;
    try {
      await this.handlers.packet(parsePacket(data));
    } catch (error) {
      this.handlers.fault(error instanceof Error ? error.message : String(error));
    }
    this.owing = true;
    if (!this.paused) this.ready();
  }

  private ready(): void {
    this.owing = false;
    this.send({ type: 'ready' });
  }

  private send(message: object): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}
