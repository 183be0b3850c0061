// SPDX-License-Identifier: Apache-2.0
import type { Packet } from '../api/packet';
import type { PartName } from '../api/types';

export type Fetch = (
  index: number,
  wanted: readonly PartName[],
  signal: AbortSignal,
) => Promise<Packet>;

/** Packets fetched before, up to a number of bytes; the longest unused goes first. */
export class FrameCache {
  private readonly packets = new Map<string, Packet>();
  private readonly pending = new Map<
    string,
    { promise: Promise<Packet>; abort: AbortController }
  >();
  private bytes = 0;

  constructor(
    private readonly fetch: Fetch,
    private readonly mostBytes: number,
  ) {}

  get(index: number, wanted: readonly PartName[]): Promise<Packet> {
    const key = `${index}:${wanted.join()}`;
    const packet = this.packets.get(key);
    if (packet) {
      this.packets.delete(key); // to the end: most lately used
      this.packets.set(key, packet);
      return Promise.resolve(packet);
    }
    return this.pending.get(key)?.promise ?? this.start(key, index, wanted);
  }

  /** Gives up what nobody waits for any more. */
  abortAllBut(index: number): void {
    for (const [key, request] of this.pending)
      if (!key.startsWith(`${index}:`)) {
        request.abort.abort();
        this.pending.delete(key);
      }
  }

  private start(key: string, index: number, wanted: readonly PartName[]): Promise<Packet> {
    const abort = new AbortController();
    const promise = this.fetch(index, wanted, abort.signal)
      .then((packet) => {
        this.keep(key, packet);
        return packet;
      })
      .finally(() => {
        if (this.pending.get(key)?.abort === abort) this.pending.delete(key);
      });
    this.pending.set(key, { promise, abort });
    return promise;
  }

  private keep(key: string, packet: Packet): void {
    this.packets.set(key, packet);
    this.bytes += packet.byteLength;
    for (const [oldest, old] of this.packets) {
      if (this.bytes <= this.mostBytes || oldest === key) break;
      this.packets.delete(oldest);
      this.bytes -= old.byteLength;
    }
  }
}
