// SPDX-License-Identifier: Apache-2.0
import { parsePacket, type Packet } from './packet';
import type { PartName } from './types';

export interface LiveHandlers {
  /** Displays a packet; the next one is requested when the promise is fulfilled. */
  packet(packet: Packet): Promise<void>;
  connected(): void;
  /** @param seconds until the next attempt to connect */
  disconnected(seconds: number): void;
  /** A packet could not be displayed. */
  fault(message: string): void;
}

const minDelay = 0.5; // seconds
const maxDelay = 8;

/** Receives the newest frame, one at a time; the server drops frames that come meanwhile. */
export class LiveConnection {
  private socket: WebSocket | null = null;
  private delay = minDelay;
  private timer = 0;
  private paused = false;
  private isIdle = false; // no packet is requested

  constructor(
    private readonly handlers: LiveHandlers,
    private parts: readonly PartName[],
    private step: number,
  ) {
    this.open();
  }

  setParts(parts: readonly PartName[], step: number): void {
    this.parts = parts;
    this.step = step;
    this.send({ type: 'want', with: parts, step });
  }

  setPaused(paused: boolean): void {
    this.paused = paused;
    if (this.isIdle) this.requestPacket();
  }

  /** Opens a new connection, because the old one may be half open. */
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
      this.delay = minDelay;
      this.handlers.connected();
      this.setParts(this.parts, this.step);
      this.requestPacket();
    };
    socket.onmessage = (event: MessageEvent<unknown>) => void this.receive(event.data);
    socket.onclose = () => this.reconnect(socket);
  }

  private reconnect(socket: WebSocket): void {
    if (this.socket !== socket) return; // closed by renew()
    this.handlers.disconnected(this.delay);
    this.timer = window.setTimeout(() => this.open(), this.delay * 1000);
    this.delay = Math.min(2 * this.delay, maxDelay);
  }

  private async receive(data: unknown): Promise<void> {
    if (!(data instanceof ArrayBuffer)) return;
    try {
      await this.handlers.packet(parsePacket(data));
    } catch (error) {
      this.handlers.fault(error instanceof Error ? error.message : String(error));
    }
    this.requestPacket();
  }

  private requestPacket(): void {
    this.isIdle = this.paused;
    if (!this.paused) this.send({ type: 'ready' });
  }

  private send(message: object): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}
