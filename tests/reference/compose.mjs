// SPDX-License-Identifier: Apache-2.0
// Files that the reference library's writer does not write, put together of its records: with bytes
// of later versions behind each record, without checksums, without the data's end.
import { crc32 } from "@foxglove/crc";
import { McapConstants, McapRecordBuilder } from "@mcap/core";

import { compressors } from "./common.mjs";

const { Opcode } = McapConstants;

class Composer {
  bytes = [];
  length = 0n;

  constructor(padding) {
    this.builder = new McapRecordBuilder({ padRecords: padding });
  }

  /** Appends what `put` builds; answers where it stands and its length. */
  add(put) {
    put(this.builder);
    const bytes = Uint8Array.from(this.builder.buffer);
    this.builder.reset();
    const place = { offset: this.length, length: BigInt(bytes.length) };
    this.bytes.push(bytes);
    this.length += place.length;
    return place;
  }

  bytesFrom(offset) {
    return Buffer.concat(this.bytes).subarray(Number(offset));
  }
}

function addChunk(composer, options, records, messages) {
  const { compression, compressedData } = compressors[options.storage]?.(records) ??
    { compression: "", compressedData: records };
  const times = messages.map((m) => m.logTime);
  const chunk = {
    messageStartTime: times.reduce((a, b) => (a < b ? a : b)),
    messageEndTime: times.reduce((a, b) => (a > b ? a : b)),
    uncompressedSize: BigInt(records.length),
    uncompressedCrc: options.crc ? crc32(records) : 0,
    compression,
    records: compressedData,
  };
  const place = composer.add((b) => b.writeChunk(chunk));
  const messageIndexOffsets = new Map();
  const indexStart = composer.length;
  if (options.messageIndex) {
    for (const channelId of new Set(messages.map((m) => m.channelId))) {
      const entries = messages.filter((m) => m.channelId === channelId);
      const index = { channelId, records: entries.map((m) => [m.logTime, m.at]) };
      messageIndexOffsets.set(channelId, composer.add((b) => b.writeMessageIndex(index)).offset);
    }
  }
  return {
    ...chunk, chunkStartOffset: place.offset, chunkLength: place.length, messageIndexOffsets,
    messageIndexLength: composer.length - indexStart, compressedSize: BigInt(compressedData.length),
  };
}

function addData(composer, options, content) {
  const chunkIndexes = [];
  const written = new Set();
  const perChunk = 4;
  for (let i = 0; i < content.messages.length; i += perChunk) {
    const group = content.messages.slice(i, i + perChunk);
    const chunk = new McapRecordBuilder({ padRecords: options.padding });
    const put = (write) => (options.storage === "loose" ? composer.add(write) : write(chunk));
    const entries = [];
    for (const { channel, ...message } of group) {
      const { schema, ...about } = content.channels[channel];
      if (schema != undefined && !written.has(`s${schema}`))
        put((b) => b.writeSchema({ ...content.schemas[schema], id: schema + 1 }));
      if (!written.has(`c${channel}`))
        put((b) => b.writeChannel({ ...about, id: channel, schemaId: (schema ?? -1) + 1 }));
      written.add(`s${schema}`).add(`c${channel}`);
      entries.push({ ...message, channelId: channel, at: BigInt(chunk.length) });
      put((b) => b.writeMessage({ ...message, channelId: channel }));
    }
    if (options.storage !== "loose")
      chunkIndexes.push(addChunk(composer, options, Uint8Array.from(chunk.buffer), entries));
    if (i === 0 && options.attachments) {
      composer.add((b) => b.writeAttachment(content.attachment));
      composer.add((b) => b.writeMetadata(content.metadata));
    }
  }
  return chunkIndexes;
}

function addSummary(composer, options, content, chunkIndexes) {
  const groups = [];
  const group = (opcode, all, put) => {
    const start = composer.length;
    for (const one of all) composer.add((b) => put(b, one));
    if (composer.length > start)
      groups.push({ groupOpcode: opcode, groupStart: start, groupLength: composer.length - start });
  };
  if (options.repeatSchemas)
    group(Opcode.SCHEMA, content.schemas.entries(), (b, [i, s]) => b.writeSchema({ ...s, id: i + 1 }));
  if (options.repeatChannels)
    group(Opcode.CHANNEL, content.channels.entries(), (b, [id, { schema, ...c }]) =>
      b.writeChannel({ ...c, id, schemaId: (schema ?? -1) + 1 }));
  const counts = new Map();
  for (const m of content.messages) counts.set(m.channel, (counts.get(m.channel) ?? 0n) + 1n);
  if (options.statistics)
    group(Opcode.STATISTICS, [{
      messageCount: BigInt(content.messages.length), schemaCount: content.schemas.length,
      channelCount: content.channels.length, attachmentCount: options.attachments ? 1 : 0,
      metadataCount: options.attachments ? 1 : 0, chunkCount: chunkIndexes.length,
      messageStartTime: 0n, messageEndTime: 90n, channelMessageCounts: counts,
    }], (b, s) => b.writeStatistics(s));
  if (options.chunkIndex) group(Opcode.CHUNK_INDEX, chunkIndexes, (b, c) => b.writeChunkIndex(c));
  const offsetStart = composer.length;
  if (options.summaryOffsets) for (const g of groups) composer.add((b) => b.writeSummaryOffset(g));
  return composer.length > offsetStart ? offsetStart : 0n;
}

export function compose(options, content) {
  const composer = new Composer(options.padding);
  composer.add((b) => b.writeMagic());
  composer.add((b) => b.writeHeader({ profile: "ros2", library: "composed" }));
  const chunkIndexes = addData(composer, options, content);
  if (options.dataEnd) {
    const dataSectionCrc = options.crc ? crc32(composer.bytesFrom(0n)) : 0;
    composer.add((b) => b.writeDataEnd({ dataSectionCrc }));
  }
  const start = composer.length;
  const summaryOffsetStart = addSummary(composer, options, content, chunkIndexes);
  const footer = { summaryStart: composer.length > start ? start : 0n, summaryOffsetStart, summaryCrc: 0 };
  if (options.crc && footer.summaryStart !== 0n) {
    // The checksum goes up to itself: over the footer's first fields, too.
    const builder = new McapRecordBuilder();
    builder.writeFooter(footer);
    const head = Uint8Array.from(builder.buffer).subarray(0, builder.length - 4);
    footer.summaryCrc = crc32(Buffer.concat([composer.bytesFrom(start), head]));
  }
  composer.add((b) => b.writeFooter(footer));
  composer.add((b) => b.writeMagic());
  return composer.bytes;
}
