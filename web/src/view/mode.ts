// SPDX-License-Identifier: Apache-2.0
import { byId, setText } from './dom';

/**
 * How many frames there are, or whether they are of now.
 * @param said the same without numbers that change with every frame: read aloud when it changes
 */
export function showMode(text: string, said = text, isFault = false): void {
  const mode = byId('mode');
  mode.classList.toggle('fault', isFault);
  setText(mode, text);
  setText(byId('mode-said'), said);
}

/** What the button does, which holds while it plays and plays while it holds. */
export function showPlaying(playing: boolean): void {
  document.documentElement.classList.toggle('playing', playing);
  byId('play').setAttribute('aria-label', playing ? 'Pause' : 'Play');
}
