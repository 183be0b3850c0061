// SPDX-License-Identifier: Apache-2.0
import { ownRoot, type Views } from './cameras';
import { parseJson, parsePacket, type Packet } from './packet';
import type { PartName, Report, SceneIndex, Session } from './types';

/** An error answer of the server; status 0: no answer. */
export class ApiError extends Error {
  override name = 'ApiError';
  constructor(
    message: string,
    readonly status: number,
  ) {
    super(message);
  }
}

/** @param read reads the body; the connection may break meanwhile */
async function get<T>(
  path: string,
  read: (response: Response) => Promise<T>,
  signal?: AbortSignal,
): Promise<T> {
  try {
    const response = await fetch(path, signal ? { signal } : {});
    if (!response.ok) throw new ApiError(await errorOf(response), response.status);
    return await read(response);
  } catch (error) {
    const isTimeout = error instanceof DOMException && error.name === 'TimeoutError';
    if (!isTimeout && !(error instanceof TypeError)) throw error; // TypeError: network failure
    throw new ApiError('The server does not respond: is penumbra still running?', 0);
  }
}

async function errorOf(response: Response): Promise<string> {
  const body = (await response.json().catch(() => null)) as { error?: unknown } | null;
  if (typeof body?.error === 'string') return body.error;
  return `HTTP status ${response.status} ${response.statusText}`;
}

const bytes = (response: Response): Promise<ArrayBuffer> => response.arrayBuffer();
const json = async <T>(path: string, signal?: AbortSignal): Promise<T> =>
  parseJson<T>(await get(path, (response) => response.text(), signal));

/** @param root of a camera */
export const fetchSession = (signal?: AbortSignal, root = ownRoot): Promise<Session> =>
  json<Session>(`${root}/api/session`, signal);

/** @param from first frame of the answer */
export const fetchReport = (from = 0, signal?: AbortSignal, root = ownRoot): Promise<Report> =>
  json<Report>(`${root}/api/report?from=${from}`, signal);

/** Fetches the verdicts over all cameras; null until all frames are judged. */
export const fetchViews = (): Promise<Views | null> => json<Views | null>('/api/views');

/** @throws ApiError of status 409 if the server or its scene changed */
export async function fetchScene(
  server: string,
  version: number,
): Promise<{ index: SceneIndex; data: ArrayBuffer }> {
  const query = `?server=${encodeURIComponent(server)}&version=${version}`;
  const [index, data] = await Promise.all([
    json<SceneIndex>(`${ownRoot}/api/scene${query}`),
    get(`${ownRoot}/api/scene.bin${query}`, bytes),
  ]);
  return { index, data };
}

/** @param step the cloud has every step-th pixel of each row and column */
export async function fetchPacket(
  index: number,
  parts: readonly PartName[],
  step: number,
  signal?: AbortSignal,
  root = ownRoot,
): Promise<Packet> {
  const query = `with=${parts.join(',')}&step=${step}`;
  return parsePacket(await get(`${root}/api/frames/${index}/packet?${query}`, bytes, signal));
}
