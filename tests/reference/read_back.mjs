// SPDX-License-Identifier: Apache-2.0
// read_back.mjs FILE...: what the reference library reads of each, with every checksum and count
// compared: a line per message by log time. Status 1 and a line on stderr where anything is amiss.
import { readFileSync } from "node:fs";
import { deepStrictEqual, strictEqual } from "node:assert";

import { crc32 } from "@foxglove/crc";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";

import { decompressHandlers, line, readable } from "./common.mjs";

/** Reads from the start to the end, as one without an index does. */
function readStream(bytes) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true, includeChunks: true });
  reader.append(bytes);
  const found = { schemas: new Map(), channels: new Map(), lines: [], chunks: 0, indexed: 0, times: [] };
  const counts = new Map();
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Chunk") ++found.chunks;
    if (record.type === "MessageIndex") found.indexed += record.records.length;
    if (record.type === "DataEnd") found.dataEnd = record;
    if (record.type === "Schema") found.schemas.set(record.id, record);
    if (record.type === "Channel") found.channels.set(record.id, record);
    if (record.type !== "Message") continue;
    const channel = found.channels.get(record.channelId);
    found.lines.push(line(channel, found.schemas.get(channel.schemaId), record));
    found.times.push(record.logTime);
    counts.set(record.channelId, (counts.get(record.channelId) ?? 0n) + 1n);
  }
  strictEqual(reader.done(), true, "the stream reader is not done");
  return { ...found, counts };
}

function checkStatistics(statistics, stream) {
  strictEqual(statistics.messageCount, BigInt(stream.lines.length));
  strictEqual(statistics.chunkCount, stream.chunks);
  strictEqual(statistics.channelCount, stream.channels.size);
  strictEqual(statistics.schemaCount, stream.schemas.size);
  deepStrictEqual(statistics.channelMessageCounts, stream.counts);
  const sorted = [...stream.times].sort((a, b) => Number(a - b));
  strictEqual(statistics.messageStartTime, sorted[0] ?? 0n);
  strictEqual(statistics.messageEndTime, sorted.at(-1) ?? 0n);
}

async function readIndexed(bytes) {
  const reader = await McapIndexedReader.Initialize({ readable: readable(bytes), decompressHandlers });
  const lines = [];
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    lines.push(line(channel, reader.schemasById.get(channel.schemaId), message));
  }
  return { reader, lines };
}

for (const file of process.argv.slice(2)) {
  const bytes = readFileSync(file);
  const stream = readStream(bytes);
  const { reader, lines } = await readIndexed(bytes);
  const data = bytes.subarray(0, Number(reader.dataEndOffset));
  if (stream.dataEnd.dataSectionCrc !== 0) strictEqual(crc32(data), stream.dataEnd.dataSectionCrc, "data CRC");
  deepStrictEqual([...lines].sort(), [...stream.lines].sort());
  strictEqual(stream.indexed, lines.length, "messages in message indexes");
  strictEqual(reader.chunkIndexes.length, stream.chunks, "chunks in the index");
  if (reader.statistics) checkStatistics(reader.statistics, stream);
  for (const [opcode, { groupStart }] of reader.summaryOffsetsByOpcode)
    strictEqual(bytes[Number(groupStart)], opcode, "summary offset");
  console.log([`# ${reader.header.profile}`, ...lines].join("\n"));
}
