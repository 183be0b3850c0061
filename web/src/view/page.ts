// SPDX-License-Identifier: Apache-2.0
// The bar at the top of the page with its notes, and the cover that replaces the page's content.
import type { Diagnosis, Session } from '../api/types';
import { plainText, setupText } from '../model/notes';
import { byId, element, setText } from './dom';

export function showInput({ input }: Session): void {
  const [path = '', ...sensor] = input.split(', '); // a sensor's topic has slashes
  const file = path.replace(/\/+$/, '').split('/').at(-1) ?? path;
  const name = [file, ...sensor].join(', ');
  document.title = `${name} · Penumbra`;
  setText(byId('input-name'), name);
  byId('input-name').title = input;
}

export interface State {
  /** Screen readers read it when it changes. */
  readonly name: string;
  /** Follows the name; changes often. */
  readonly numbers?: string;
  readonly isFault?: boolean;
}

export function showState({ name, numbers = '', isFault = false }: State): void {
  byId('state').classList.toggle('fault', isFault);
  setText(byId('state-name'), name);
  setText(byId('state-numbers'), numbers);
}

export function showPlaying(isPlaying: boolean): void {
  document.documentElement.classList.toggle('playing', isPlaying);
  byId('play').setAttribute('aria-label', isPlaying ? 'Pause' : 'Play');
}

export interface Notes {
  readonly title: string;
  readonly level: 'ok' | 'warn' | 'fault';
  /** Commands are between backticks. */
  readonly lines: readonly string[];
}

let shownNotes = '';

/** Lists notes below the bar, and shows the button that hides them; hidden are those of level ok. */
export function showNotes(notes: Notes): void {
  const { title, level, lines } = notes;
  const json = JSON.stringify(notes);
  if (json === shownNotes) return;
  shownNotes = json;
  const button = byId('notes-button');
  // Changed lines do not open a list again that the user has closed.
  const isNew = button.hidden || !button.classList.contains(level);
  button.hidden = lines.length === 0;
  button.className = `chip ${level}`;
  setText(button, level === 'ok' ? title : `${title} (${lines.length})`);
  byId('notes').replaceChildren(...lines.map((line) => element('li', '', ...withCommands(line))));
  if (isNew || button.hidden) openNotes(level !== 'ok' && !button.hidden);
}

export function openNotes(open: boolean): void {
  byId('notes').hidden = !open;
  byId('notes-button').ariaExpanded = String(open);
}

/** Returns a line whose commands, between backticks, are elements. */
export const withCommands = (line: string): (Node | string)[] =>
  plainText(line)
    .split('`')
    .map((part, index) => (index % 2 ? element('code', '', part) : part));

/** Shows what is wrong with the setup, with a button for the frame that shows it. */
export function showDiagnosis(diagnosis: Diagnosis | null, seek: (index: number) => void): void {
  byId('diagnosis').hidden = !diagnosis;
  if (!diagnosis) return;
  setText(byId('diagnosis-text'), setupText(diagnosis));
  const button = byId('diagnosis-frame');
  setText(button, `Show frame ${diagnosis.frame}`);
  button.onclick = () => seek(diagnosis.frame);
}

export type Action = readonly [label: string, run: () => void];

/** Covers the page with a message or error, and buttons. */
export function cover(reason: unknown, actions: readonly Action[], isFault = true): void {
  const message = reason instanceof Error ? reason.message : String(reason);
  const buttons = actions.map(([label, run], index) => {
    const button = element('button', index === 0 ? 'primary' : '', label);
    button.addEventListener('click', run);
    return button;
  });
  byId('cover').replaceChildren(element('p', isFault ? 'fault' : '', message), ...buttons);
  byId('cover').hidden = false;
}

export const coverReplaced = (): void =>
  cover('The server now shows another input. Reload the page.', [
    ['Reload', () => location.reload()],
  ]);

export function uncover(): void {
  byId('cover').hidden = true;
  byId('main').setAttribute('aria-busy', 'false');
}
