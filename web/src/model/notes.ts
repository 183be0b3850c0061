// SPDX-License-Identifier: Apache-2.0
// The texts of a run's notes and of the diagnosis of its setup.
import type { Diagnosis, Summary } from '../api/types';

/** Replaces what a terminal cannot print. */
export const plainText = (line: string): string => line.replaceAll(' +- ', ' ± ');

export const setupText = ({ message }: Diagnosis): string => `Setup: ${plainText(message)}.`;

/** Returns the notes without the diagnosis, which the pages show by itself. */
export const notesOf = (summary: Summary | null): readonly string[] =>
  (summary?.notes ?? []).filter((note) => note !== summary?.diagnosis?.message);
