// SPDX-License-Identifier: Apache-2.0
// A frame packet: uint32 little-endian length of the JSON, the JSON, the parts' bytes in its order.
import type { FrameReport, LiveStatus, PartName, Pose } from './types';

interface PartHeader {
  readonly name: string;
  readonly type: string;
  readonly size: number;
  readonly width?: number;
  readonly height?: number;
}

/** A target in the image, pixels. */
export interface Mark {
  /** Lines: u, v, u, v... */
  readonly outline: readonly (readonly number[])[];
  /** Position of a handled target. */
  readonly place: readonly [number, number] | null;
}

interface PacketHeader {
  readonly frame: FrameReport;
  /** Random number of the server process. */
  readonly server: string;
  readonly scene_version: number;
  readonly link_poses: readonly (Pose | null)[];
  readonly camera_pose: Pose | null;
  /** One per target of the frame; absent if the server has no outlines. */
  readonly marks?: readonly Mark[];
  readonly parts: readonly PartHeader[];
  readonly live?: LiveStatus;
}

export interface EncodedImage {
  readonly type: string;
  readonly bytes: Uint8Array<ArrayBuffer>;
}

export interface Grid<T> {
  readonly width: number;
  readonly height: number;
  readonly values: T;
}

/** The parts that were requested and that the frame has. */
interface Parts {
  color?: EncodedImage;
  overlay?: EncodedImage;
  labels?: Grid<Uint8Array>;
  /** The robot's outline: 1 by the camera's pose in use, 2 by the pose that its calibration found. */
  outlines?: Grid<Uint8Array>;
  links?: Grid<Uint16Array>;
  vdi?: Grid<Float32Array>;
  depth?: Grid<Float32Array>;
  /** Per point float32 x y z in the optical frame, uint8 label, r, g, b. */
  cloud?: Uint8Array<ArrayBuffer>;
}

export interface Packet extends PacketHeader, Readonly<Parts> {
  readonly byteLength: number;
}

export const pointBytes = 16;

export class PacketError extends Error {
  override name = 'PacketError';
}

/** Characters that change the direction of text: a name with one would reorder the text around it. */
const directionMarks = /[\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]/g;

/**
 * Parses JSON. `stamp_ns` becomes text, because a double does not hold its digits. (In strings quotes
 * are escaped, so the pattern matches keys only.) Replaces direction marks.
 * @throws SyntaxError
 */
export function parseJson<T>(text: string): T {
  return JSON.parse(
    text.replace(directionMarks, '\ufffd').replace(/("stamp_ns"\s*:\s*)(-?\d+)/g, '$1"$2"'),
  ) as T;
}

/** @throws PacketError for a wrong length, size or JSON */
export function parsePacket(buffer: ArrayBuffer): Packet {
  const { header, offset } = readHeader(buffer);
  const parts: Parts = {};
  let at = offset;
  for (const part of header.parts) {
    if (!Number.isInteger(part.size) || part.size < 0 || at + part.size > buffer.byteLength)
      throw new PacketError(`packet: part ${part.name} exceeds the packet`);
    // slice() copies, so that float arrays are aligned.
    readPart(parts, part, buffer.slice(at, at + part.size));
    at += part.size;
  }
  if (at !== buffer.byteLength)
    throw new PacketError(`packet: ${buffer.byteLength - at} extra bytes`);
  return { ...header, ...parts, byteLength: buffer.byteLength };
}

function readHeader(buffer: ArrayBuffer): { header: PacketHeader; offset: number } {
  if (buffer.byteLength < 4) throw new PacketError('packet: no length field');
  const length = new DataView(buffer).getUint32(0, true);
  const offset = 4 + length;
  if (offset > buffer.byteLength) throw new PacketError('packet: truncated JSON');
  let header: PacketHeader;
  try {
    const json = new Uint8Array(buffer, 4, length);
    header = parseJson(new TextDecoder('utf-8', { fatal: true }).decode(json));
  } catch (error) {
    throw new PacketError(`packet: invalid JSON: ${String(error)}`);
  }
  if (!header.frame || !Array.isArray(header.parts) || !Array.isArray(header.link_poses))
    throw new PacketError('packet: frame, parts or link_poses is missing');
  return { header, offset };
}

function readPart(parts: Parts, part: PartHeader, bytes: ArrayBuffer): void {
  const name = part.name as PartName; // another name: a part that this page does not use
  switch (name) {
    case 'color':
    case 'overlay':
      parts[name] = { type: part.type, bytes: new Uint8Array(bytes) };
      break;
    case 'labels':
    case 'outlines':
      parts[name] = { ...sizeOf(part, 1), values: new Uint8Array(bytes) };
      break;
    case 'links':
      parts.links = { ...sizeOf(part, 2), values: new Uint16Array(bytes) };
      break;
    case 'vdi':
    case 'depth':
      parts[name] = { ...sizeOf(part, 4), values: new Float32Array(bytes) };
      break;
    case 'cloud':
      if (part.size % pointBytes !== 0) throw new PacketError('packet: truncated cloud');
      parts.cloud = new Uint8Array(bytes);
  }
}

function sizeOf(part: PartHeader, pixelBytes: number): { width: number; height: number } {
  const { width = 0, height = 0 } = part;
  if (width * height * pixelBytes !== part.size || width <= 0)
    throw new PacketError(`packet: ${part.name} of ${width}x${height} has ${part.size} bytes`);
  return { width, height };
}
