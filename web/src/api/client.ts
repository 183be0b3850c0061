// SPDX-License-Identifier: Apache-2.0
import { parseJson } from './json';
import { parsePacket, type Packet } from './packet';
import type { PartName, Report, SceneIndex, Session } from './types';

/** What the server answered instead of what was asked for, in its own words. */
export class ApiError extends Error {
  override name = 'ApiError';
  constructor(
    message: string,
    readonly status: number,
  ) {
    super(message);
  }
}

/** @param read takes the whole answer: a server may go away in the midst of it */
async function get<T>(
  path: string,
  read: (response: Response) => Promise<T>,
  signal?: AbortSignal,
): Promise<T> {
  try {
    const response = await fetch(path, signal ? { signal } : {});
    if (!response.ok) throw new ApiError(await reasonOf(response), response.status);
    return await read(response);
  } catch (error) {
    const isLate = error instanceof DOMException && error.name === 'TimeoutError';
    if (!isLate && !(error instanceof TypeError)) throw error; // fetch's own way to say it failed
    throw new ApiError('the server does not answer: is penumbra view still running?', 0);
  }
}

async function reasonOf(response: Response): Promise<string> {
  try {
    const body = parseJson<{ error?: unknown }>(await response.text());
    if (typeof body.error === 'string') return body.error;
  } catch {
    // no JSON: the status says what there is to say
  }
  return `the server answered ${response.status} ${response.statusText}`;
}

const bytes = (response: Response): Promise<ArrayBuffer> => response.arrayBuffer();
const json = async <T>(path: string, signal?: AbortSignal): Promise<T> =>
  parseJson<T>(await get(path, (response) => response.text(), signal));

export const fetchSession = (signal?: AbortSignal): Promise<Session> =>
  json<Session>('/api/session', signal);
/** @param from frames of it to leave out, which are known */
export const fetchReport = (from = 0, signal?: AbortSignal): Promise<Report> =>
  json<Report>(`/api/report?from=${from}`, signal);

/** @throws ApiError of status 409 where that server has another scene by now, or is another */
export async function fetchScene(
  server: string,
  version: number,
): Promise<{ index: SceneIndex; data: ArrayBuffer }> {
  const query = `?server=${encodeURIComponent(server)}&version=${version}`;
  const [index, data] = await Promise.all([
    json<SceneIndex>(`/api/scene${query}`),
    get(`/api/scene.bin${query}`, bytes),
  ]);
  return { index, data };
}

/** @param step every step-th pixel in both directions becomes a point of the cloud */
export async function fetchPacket(
  index: number,
  wanted: readonly PartName[],
  step: number,
  signal?: AbortSignal,
): Promise<Packet> {
  const query = `with=${wanted.join(',')}&step=${step}`;
  return parsePacket(await get(`/api/frames/${index}/packet?${query}`, bytes, signal));
}
