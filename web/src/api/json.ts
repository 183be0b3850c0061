// SPDX-License-Identifier: Apache-2.0

/** Marks that turn the direction of text: a name that holds one would reorder what is written around it. */
const directionMarks = /[\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]/g;

/**
 * Parses JSON whose stamps are nanoseconds: they have more digits than a double holds, so they
 * become text. A string's own quotes are escaped, so that the pattern meets keys alone. Names of
 * others come into the page here, and come without direction marks.
 * @throws SyntaxError
 */
export function parseJson<T>(text: string): T {
  return JSON.parse(
    text.replace(directionMarks, '\ufffd').replace(/("stamp_ns"\s*:\s*)(-?\d+)/g, '$1"$2"'),
  ) as T;
}
