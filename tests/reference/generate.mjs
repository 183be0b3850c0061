// SPDX-License-Identifier: Apache-2.0
// generate.mjs FOLDER: the same messages in every way in which the reference library writes a file.
// Each file is named by its options; messages.txt has the messages by log time.
import { writeFileSync } from "node:fs";
import { join } from "node:path";

import { McapWriter } from "@mcap/core";

import { compressors, line } from "./common.mjs";

const folder = process.argv[2];
const text = new TextEncoder();

const schemas = [
  { name: "pkg/msg/A", encoding: "ros2msg", data: text.encode("int32 a\n") },
  { name: "pkg/msg/B", encoding: "ros2msg", data: text.encode("string b\nint32[] more\n") },
];
const channels = [
  { schema: 0, topic: "/a", messageEncoding: "cdr", metadata: new Map([["offered_qos_profiles", "- x"]]) },
  { schema: 1, topic: "/b", messageEncoding: "cdr", metadata: new Map() },
  { schema: undefined, topic: "/none", messageEncoding: "json", metadata: new Map([["", ""], ["k", "ü"]]) },
];
// Times neither rise nor differ; what is given is the order in the file.
const times = [50n, 10n, 10n, 70n, 20n, 20n, 90n, 0n, 40n, 60n, 30n, 90n];
const messages = times.map((logTime, i) => ({
  channel: i % channels.length,
  sequence: i,
  logTime,
  publishTime: logTime + 5n,
  data: Uint8Array.from({ length: (i * 37) % 150 }, (_, k) => (k * (i + 1)) % 251),
}));
const attachment = {
  logTime: 12n, createTime: 3n, name: "a.txt", mediaType: "text/plain", data: text.encode("attached"),
};
const metadata = { name: "about", metadata: new Map([["who", "reference"], ["", ""]]) };

class Sink {
  bytes = [];
  length = 0;
  async write(buffer) {
    this.bytes.push(Uint8Array.from(buffer));
    this.length += buffer.length;
  }
  position() {
    return BigInt(this.length);
  }
}

/** Every combination of the values that `choices` lists by name. */
function* combinations(choices) {
  const [first, ...rest] = Object.entries(choices);
  if (first == undefined) {
    yield {};
    return;
  }
  for (const others of combinations(Object.fromEntries(rest)))
    for (const value of first[1]) yield { [first[0]]: value, ...others };
}

async function written(options) {
  const sink = new Sink();
  const { storage, attachments, metadatas, ...flags } = options;
  const writer = new McapWriter({
    writable: sink, ...flags, useChunks: storage !== "loose", chunkSize: 200,
    compressChunk: compressors[storage],
  });
  await writer.start({ profile: "ros2", library: "reference" });
  const schemaIds = [];
  for (const schema of schemas) schemaIds.push(await writer.registerSchema(schema));
  const ids = [];
  for (const { schema, ...channel } of channels)
    ids.push(await writer.registerChannel({ ...channel, schemaId: schema == undefined ? 0 : schemaIds[schema] }));
  for (const [i, { channel, ...message }] of messages.entries()) {
    if (i === 4 && attachments) await writer.addAttachment(attachment);
    if (i === 7 && metadatas) await writer.addMetadata(metadata);
    await writer.addMessage({ ...message, channelId: ids[channel] });
  }
  await writer.end();
  return sink.bytes;
}

const either = [false, true];
for (const options of combinations({
  storage: ["loose", "none", "lz4", "zstd"], useStatistics: either, useSummaryOffsets: either,
  repeatSchemas: either, repeatChannels: either, useAttachmentIndex: either,
  useMetadataIndex: either, useMessageIndex: either, useChunkIndex: either, attachments: either,
  metadatas: either,
})) {
  const name = Object.entries(options).map(([key, value]) =>
    value === true ? key : value === false ? "" : value).filter((part) => part !== "").join("_");
  writeFileSync(join(folder, `${name}.mcap`), Buffer.concat(await written(options)));
}

const ordered = [...messages].sort((a, b) => Number(a.logTime - b.logTime));
const lines = ordered.map((m) => line(channels[m.channel], schemas[channels[m.channel].schema], m));
writeFileSync(join(folder, "messages.txt"), lines.join("\n") + "\n");
