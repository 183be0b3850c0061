// SPDX-License-Identifier: Apache-2.0
// node ros_messages.mjs decode LIST: LIST holds lines "TYPE DEFINITION_FILE PAYLOAD_FILE"; prints the
// messages as a JSON array. node ros_messages.mjs definitions: prints what others say that Humble's
// messages are.
import { readFileSync } from "node:fs";
import { parse } from "@foxglove/rosmsg";
import { ros2humble } from "@foxglove/rosmsg-msgs-common";
import { MessageReader } from "@foxglove/rosmsg2-serialization";

// JSON knows neither NaN and infinity nor 64 bits: they are written as text.
function plain(_, value) {
  if (typeof value === "bigint") return value.toString();
  if (typeof value === "number" && !Number.isFinite(value)) return String(value);
  if (ArrayBuffer.isView(value)) return Array.from(value, (one) => plain("", one));
  return value;
}

function decode(list) {
  return readFileSync(list, "utf8").trim().split("\n").map((line) => {
    const [, definition, payload] = line.split(" ");
    const types = parse(readFileSync(definition, "utf8"), { ros2: true });
    return new MessageReader(types).readMessage(readFileSync(payload));
  });
}

function definitions() {
  return Object.fromEntries(Object.entries(ros2humble).map(([name, { definitions: fields }]) =>
    [name, fields.map((field) => [field.name, field.type, field.isConstant ? "constant" :
      field.isArray ? `[${field.arrayLength ?? ""}]` : "", field.valueText ?? ""])]));
}

const [, , task, list] = process.argv;
process.stdout.write(JSON.stringify(task === "decode" ? decode(list) : definitions(), plain));
