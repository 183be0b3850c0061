// SPDX-License-Identifier: Apache-2.0
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { PacketError, parsePacket } from '../../src/api/packet';

interface Part {
  readonly name: string;
  readonly type: string;
  readonly bytes: Uint8Array;
  readonly width?: number;
  readonly height?: number;
}

const frame =
  '{"index": 7, "stamp_ns": 1700000000300000001, "joint_age_ms": 0.5, "status": "ok", "message": "\\"stamp_ns\\": 5", "pixels": {}, "timing_ms": {}, "targets": []}';

/** Writes a packet as documented. */
function packetOf(parts: readonly Part[], frameText = frame): ArrayBuffer {
  const heads = parts.map(({ name, type, bytes, width, height }) =>
    JSON.stringify({ name, type, size: bytes.length, width, height }),
  );
  const json = new TextEncoder().encode(
    `{"frame": ${frameText}, "scene_version": 3, "link_poses": [[1, 2, 3, 0, 0, 0, 1], null], "camera_pose": null, "parts": [${heads.join()}]}`,
  );
  const size = 4 + json.length + parts.reduce((sum, part) => sum + part.bytes.length, 0);
  const packet = new Uint8Array(size);
  packet.set([json.length & 255, (json.length >> 8) & 255, (json.length >> 16) & 255, 0]);
  packet.set(json, 4);
  let at = 4 + json.length;
  for (const { bytes } of parts) {
    packet.set(bytes, at);
    at += bytes.length;
  }
  return packet.buffer;
}

const labels: Part = {
  name: 'labels',
  type: 'u8',
  bytes: Uint8Array.of(0, 1, 2, 3, 4, 0),
  width: 3,
  height: 2,
};
const depth: Part = {
  name: 'depth',
  type: 'f32',
  bytes: Uint8Array.of(0, 0, 128, 63, 0, 0, 0, 64),
  width: 2,
  height: 1,
};
const cloud: Part = { name: 'cloud', type: 'xyzlrgb', bytes: new Uint8Array(32) };

test('reads a packet', () => {
  const packet = parsePacket(packetOf([labels, depth, cloud]));
  assert.equal(packet.frame.index, 7);
  assert.equal(packet.scene_version, 3);
  assert.deepEqual(packet.link_poses, [[1, 2, 3, 0, 0, 0, 1], null]);
  assert.equal(packet.camera_pose, null);
  assert.deepEqual([...(packet.labels?.values ?? [])], [0, 1, 2, 3, 4, 0]);
  assert.deepEqual([...(packet.depth?.values ?? [])], [1, 2]);
  assert.equal(packet.cloud?.length, 32);
  assert.equal(packet.color, undefined);
});

test('a stamp keeps its nanoseconds, and texts do not change', () => {
  const packet = parsePacket(packetOf([]));
  assert.equal(packet.frame.stamp_ns, '1700000000300000001');
  assert.equal(packet.frame.message, '"stamp_ns": 5');
});

test('refuses a packet truncated at any length', () => {
  const whole = packetOf([labels, depth, cloud]);
  for (let length = 0; length < whole.byteLength; ++length)
    assert.throws(() => parsePacket(whole.slice(0, length)), PacketError, `${length} bytes`);
});

test('refuses wrong sizes', () => {
  assert.throws(() => parsePacket(packetOf([{ ...labels, width: 4 }])), PacketError);
  assert.throws(() => parsePacket(packetOf([{ ...labels, width: -3, height: -2 }])), PacketError);
  assert.throws(
    () => parsePacket(packetOf([{ ...cloud, bytes: new Uint8Array(17) }])),
    PacketError,
  );
  const long = new Uint8Array(packetOf([labels]).byteLength + 1);
  long.set(new Uint8Array(packetOf([labels])));
  assert.throws(() => parsePacket(long.buffer), PacketError);
});

test('ignores unknown parts', () => {
  const packet = parsePacket(
    packetOf([{ name: 'heat', type: 'f16', bytes: new Uint8Array(3) }, labels]),
  );
  assert.equal(packet.labels?.values[1], 1);
});
