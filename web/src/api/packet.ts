// SPDX-License-Identifier: Apache-2.0
// A frame packet: uint32 little-endian length of the JSON, the JSON, the parts' bytes in its order.
import { parseJson } from './json';
import type { FrameReport, LiveState, PartName, Pose } from './types';

interface PartHeader {
  readonly name: string;
  readonly type: string;
  readonly size: number;
  readonly width?: number;
  readonly height?: number;
}

/** What is drawn of a target in the image, in pixels. */
export interface Mark {
  /** Lines: u, v, u, v... */
  readonly outline: readonly (readonly number[])[];
  /** Where a handled target is. */
  readonly place: readonly [number, number] | null;
}

interface PacketHeader {
  readonly frame: FrameReport;
  readonly server: string;
  readonly scene_version: number;
  readonly link_poses: readonly (Pose | null)[];
  readonly camera_pose: Pose | null;
  readonly marks?: readonly Mark[];
  readonly parts: readonly PartHeader[];
  readonly live?: LiveState;
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

/** 16 bytes a point: float32 x y z in the optical frame, uint8 label, r, g, b. */
export interface Cloud {
  readonly count: number;
  readonly bytes: Uint8Array<ArrayBuffer>;
}

export interface Packet {
  readonly frame: FrameReport;
  /** Which process sent it. */
  readonly server: string;
  readonly sceneVersion: number;
  readonly linkPoses: readonly (Pose | null)[];
  readonly cameraPose: Pose | null;
  /** One for each target of the frame; empty where the server has no outlines. */
  readonly marks: readonly Mark[];
  readonly live: LiveState | null;
  readonly byteLength: number;
  /** What came: a part that is not here was not asked for, or cannot be had of this frame. */
  readonly has: ReadonlySet<string>;
  readonly color?: EncodedImage;
  readonly overlay?: EncodedImage;
  readonly labels?: Grid<Uint8Array>;
  readonly links?: Grid<Uint16Array>;
  readonly vdi?: Grid<Float32Array>;
  readonly depth?: Grid<Float32Array>;
  readonly cloud?: Cloud;
}

export const pointBytes = 16;

/** What is wrong with a packet, in one line. */
export class PacketError extends Error {
  override name = 'PacketError';
}

type Parts = { -readonly [K in PartName]?: Packet[K] };

/** @throws PacketError where a length, a size or the JSON is wrong: no part of it is used then. */
export function parsePacket(buffer: ArrayBuffer): Packet {
  const { header, offset } = readHeader(buffer);
  const parts: Parts = {};
  let at = offset;
  for (const part of header.parts) {
    if (!Number.isInteger(part.size) || part.size < 0 || at + part.size > buffer.byteLength)
      throw new PacketError(`packet: part ${part.name} reaches beyond its end`);
    // A copy begins at offset 0, as arrays of floats must at a multiple of 4.
    readPart(parts, part, buffer.slice(at, at + part.size));
    at += part.size;
  }
  if (at !== buffer.byteLength)
    throw new PacketError(`packet: ${buffer.byteLength - at} bytes too many`);
  return {
    frame: header.frame,
    server: header.server,
    sceneVersion: header.scene_version,
    linkPoses: header.link_poses,
    cameraPose: header.camera_pose,
    marks: header.marks ?? [],
    live: header.live ?? null,
    byteLength: buffer.byteLength,
    has: new Set(header.parts.map((part) => part.name)),
    ...(parts as Pick<Packet, PartName>),
  };
}

function readHeader(buffer: ArrayBuffer): { header: PacketHeader; offset: number } {
  if (buffer.byteLength < 4) throw new PacketError('packet: shorter than its length field');
  const length = new DataView(buffer).getUint32(0, true);
  const offset = 4 + length;
  if (offset > buffer.byteLength) throw new PacketError('packet: shorter than its JSON');
  try {
    const text = new TextDecoder('utf-8', { fatal: true }).decode(
      new Uint8Array(buffer, 4, length),
    );
    const header = parseJson<PacketHeader>(text);
    if (!header.frame || !Array.isArray(header.parts) || !Array.isArray(header.link_poses))
      throw new PacketError('packet: frame, parts or link_poses are not there');
    return { header, offset };
  } catch (error) {
    if (error instanceof PacketError) throw error;
    throw new PacketError(`packet: its JSON cannot be read: ${String(error)}`);
  }
}

function readPart(parts: Parts, part: PartHeader, bytes: ArrayBuffer): void {
  switch (part.name) {
    case 'color':
    case 'overlay':
      parts[part.name] = { type: part.type, bytes: new Uint8Array(bytes) };
      break;
    case 'labels':
      parts.labels = { ...sizeOf(part, 1), values: new Uint8Array(bytes) };
      break;
    case 'links':
      parts.links = { ...sizeOf(part, 2), values: new Uint16Array(bytes) };
      break;
    case 'vdi':
    case 'depth':
      parts[part.name] = { ...sizeOf(part, 4), values: new Float32Array(bytes) };
      break;
    case 'cloud':
      if (part.size % pointBytes !== 0) throw new PacketError('packet: cloud of half a point');
      parts.cloud = { count: part.size / pointBytes, bytes: new Uint8Array(bytes) };
      break;
    default: // a later server's: not for this page
  }
}

function sizeOf(part: PartHeader, bytesOfPixel: number): { width: number; height: number } {
  const { width = 0, height = 0 } = part;
  if (width * height * bytesOfPixel !== part.size || width <= 0)
    throw new PacketError(`packet: ${part.name} of ${width}x${height} has ${part.size} bytes`);
  return { width, height };
}
