// SPDX-License-Identifier: Apache-2.0
import type { Packet } from '../api/packet';
import type { PartName } from '../api/types';

type Fetch = (index: number, parts: readonly PartName[], signal: AbortSignal) => Promise<Packet>;

interface Entry {
  readonly index: number;
  readonly abort: AbortController;
  readonly packet: Promise<Packet>;
  bytes: number; // 0 while the packet is being fetched
}

/** Fetches packets and keeps up to a number of bytes; deletes the least recently used first. */
export class FrameCache {
  private readonly entries = new Map<string, Entry>(); // least recently used first

  constructor(
    private readonly fetch: Fetch,
    private readonly maxBytes: number,
  ) {}

  get(index: number, parts: readonly PartName[]): Promise<Packet> {
    const key = `${index}:${parts.join()}`;
    const entry = this.entries.get(key) ?? this.start(key, index, parts);
    this.entries.delete(key);
    this.entries.set(key, entry);
    return entry.packet;
  }

  /** Aborts requests of other frames. */
  abortExcept(index: number): void {
    for (const [key, entry] of this.entries)
      if (entry.bytes === 0 && entry.index !== index) {
        this.entries.delete(key);
        entry.abort.abort();
      }
  }

  private start(key: string, index: number, parts: readonly PartName[]): Entry {
    const abort = new AbortController();
    const packet = this.fetch(index, parts, abort.signal);
    const entry: Entry = { index, abort, packet, bytes: 0 };
    packet.then(
      ({ byteLength }) => {
        entry.bytes = byteLength;
        this.shrink();
      },
      () => this.entries.get(key) === entry && this.entries.delete(key),
    );
    return entry;
  }

  private shrink(): void {
    let bytes = [...this.entries.values()].reduce((sum, entry) => sum + entry.bytes, 0);
    for (const [key, entry] of this.entries) {
      if (bytes <= this.maxBytes || this.entries.size === 1) break;
      this.entries.delete(key);
      bytes -= entry.bytes;
    }
  }
}
