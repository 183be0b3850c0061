// SPDX-License-Identifier: Apache-2.0

/**
 * Parses JSON whose stamps are nanoseconds: they have more digits than a double holds, so they
 * become text. A string's own quotes are escaped, so that the pattern meets keys alone.
 * @throws SyntaxError
 */
export function parseJson<T>(text: string): T {
  return JSON.parse(text.replace(/("stamp_ns"\s*:\s*)(-?\d+)/g, '$1"$2"')) as T;
}
