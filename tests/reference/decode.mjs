// SPDX-License-Identifier: Apache-2.0
// decode.mjs FILE: ROS 2's messages of a bag by log time, decoded by their own schemas: one line of
// JSON each. Long arrays are given by length and CRC of their bytes.
import { readFileSync } from "node:fs";

import { crc32 } from "@foxglove/crc";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader } from "@mcap/core";

import { decompressHandlers, readable } from "./common.mjs";

const longest = 64;

function plain(_key, value) {
  if (typeof value === "bigint") return value.toString();
  if (typeof value === "number" && !Number.isFinite(value)) return String(value);
  if (!ArrayBuffer.isView(value)) return value;
  if (value.length <= longest) return Array.from(value);
  const bytes = new Uint8Array(value.buffer, value.byteOffset, value.byteLength);
  return { length: value.length, crc: crc32(bytes).toString(16).padStart(8, "0") };
}

const file = readable(readFileSync(process.argv[2]));
const reader = await McapIndexedReader.Initialize({ readable: file, decompressHandlers });
const decoders = new Map();
for (const [id, schema] of reader.schemasById)
  decoders.set(id, new MessageReader(parse(new TextDecoder().decode(schema.data), { ros2: true })));
for await (const { channelId, logTime, publishTime, data } of reader.readMessages()) {
  const { topic, schemaId } = reader.channelsById.get(channelId);
  const message = decoders.get(schemaId).readMessage(data);
  const type = reader.schemasById.get(schemaId).name;
  console.log(JSON.stringify({ topic, type, logTime, publishTime, message }, plain));
}
