// SPDX-License-Identifier: Apache-2.0
// What the scripts share: codecs, and a message as one line of text.
import { createRequire } from "node:module";

import { crc32 } from "@foxglove/crc";
import lz4 from "@foxglove/wasm-lz4";
import * as zstd from "@foxglove/wasm-zstd";

const lz4js = createRequire(import.meta.url)("lz4js");

await Promise.all([zstd.default?.isLoaded ?? zstd.isLoaded, lz4.isLoaded]);
const zstdCodec = zstd.default ?? zstd;

export const decompressHandlers = {
  lz4: (buffer, size) => lz4(buffer, Number(size)),
  zstd: (buffer, size) => zstdCodec.decompress(buffer, Number(size)),
};

export const compressors = {
  none: undefined,
  lz4: (data) => ({ compression: "lz4", compressedData: Uint8Array.from(lz4js.compress(data)) }),
  zstd: (data) => ({ compression: "zstd", compressedData: zstdCodec.compress(data, 3) }),
};

/** A file for the library's indexed reader. */
export const readable = (bytes) => ({
  size: async () => BigInt(bytes.length),
  read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
});

/** TOPIC SCHEMA SEQUENCE LOG_TIME PUBLISH_TIME SIZE CRC; "-" for no schema. */
export function line(channel, schema, message) {
  const { sequence, logTime, publishTime, data } = message;
  const crc = crc32(data).toString(16).padStart(8, "0");
  const name = schema?.name ?? "-";
  return `${channel.topic} ${name} ${sequence} ${logTime} ${publishTime} ${data.length} ${crc}`;
}
