// SPDX-License-Identifier: Apache-2.0
// node ros_messages.mjs decode LIST: LIST holds lines "TYPE DEFINITION_FILE PAYLOAD_FILE"; prints the
// messages as a JSON array. node ros_messages.mjs definitions LIST: prints the fields and constants
// of each type in the definitions, beside those that others have for Humble. node ros_messages.mjs
// encode LIST: writes the message in each PAYLOAD_FILE, as JSON, in CDR to the same file.
import { readFileSync, writeFileSync } from "node:fs";
import { parse } from "@foxglove/rosmsg";
import { ros2humble } from "@foxglove/rosmsg-msgs-common";
import { MessageReader, MessageWriter } from "@foxglove/rosmsg2-serialization";

// JSON knows neither NaN and infinity nor 64 bits: they are written as text.
function plain(_, value) {
  if (typeof value === "bigint") return value.toString();
  if (typeof value === "number" && !Number.isFinite(value)) return String(value);
  if (ArrayBuffer.isView(value)) return Array.from(value, (one) => plain("", one));
  return value;
}

function lines(list) {
  return readFileSync(list, "utf8").trim().split("\n").map((line) => line.split(" "));
}

const parsed = (file) => parse(readFileSync(file, "utf8"), { ros2: true });

function decode(list) {
  return lines(list).map(([, definition, payload]) =>
    new MessageReader(parsed(definition)).readMessage(readFileSync(payload)));
}

function encode(list) {
  for (const [, definition, payload] of lines(list)) {
    const message = JSON.parse(readFileSync(payload, "utf8"));
    writeFileSync(payload, new MessageWriter(parsed(definition)).writeMessage(message));
  }
  return [];
}

function rows(fields) {
  return fields.map((field) => [field.name, field.type, field.isConstant ? "constant" :
    field.isArray ? `[${field.arrayLength ?? ""}]` : "", field.valueText ?? ""]);
}

function definitions(list) {
  const both = {};
  for (const [type, file] of lines(list))
    for (const { name = type.replace("/msg/", "/"), definitions: ours } of parsed(file))
      if (ros2humble[name]) both[name] = [rows(ours), rows(ros2humble[name].definitions)];
  return both;
}

const [, , task, list] = process.argv;
const tasks = { decode, definitions, encode };
process.stdout.write(JSON.stringify(tasks[task](list), plain));
