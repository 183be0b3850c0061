// SPDX-License-Identifier: Apache-2.0
// The page's bar, and what covers the page while there is nothing to see.
import type { Session } from '../api/types';
import { byId, element, setText } from './dom';

export function showInput({ input }: Session): void {
  const name = input.replace(/\/+$/, '').split('/').at(-1) ?? input;
  document.title = `${name} · Penumbra`;
  setText(byId('input-name'), name);
  byId('input-name').title = input;
}

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

let toldNotes = '';

/**
 * Sentences behind one button: what is not there, and the command that gives it.
 * @param level how much it matters: ok, warn or fault
 * @param count of them, those that are amiss
 */
export function showNotes(
  sentences: readonly string[],
  title: string,
  level: 'ok' | 'warn' | 'fault' = 'warn',
  count = sentences.length,
): void {
  const notes = [title, level, count, ...sentences].join('\n');
  if (notes === toldNotes) return;
  toldNotes = notes;
  const button = byId<HTMLButtonElement>('missing-button');
  button.hidden = sentences.length === 0;
  button.className = `chip ${level}`;
  setText(button, level === 'ok' ? title : `${title} (${count})`);
  const items = sentences.map((sentence) => element('li', '', ...withCommands(sentence)));
  const dialog = fillDialog('missing', title, element('ul', '', ...items));
  button.onclick = () => dialog.showModal();
}

/** What stands between backticks is a command. */
const withCommands = (sentence: string): (Node | string)[] =>
  sentence.split('`').map((part, index) => (index % 2 ? element('code', '', part) : part));

/** A dialog with a heading, and a button that closes it. */
export function fillDialog(id: string, title: string, ...content: Node[]): HTMLDialogElement {
  const dialog = byId<HTMLDialogElement>(id);
  const heading = element('h2', '', title);
  heading.id = `${id}-title`;
  const close = element('button', 'primary', 'Close');
  close.addEventListener('click', () => dialog.close());
  dialog.replaceChildren(heading, ...content, close);
  dialog.onclick = (event) => event.target === dialog && dialog.close();
  return dialog;
}

/**
 * Over the page: why there is nothing to see, and ways on.
 * @param ways what a button says, and what it does
 */
export function cover(
  reason: unknown,
  ways: readonly (readonly [string, () => void])[],
  isFault = true,
): void {
  const message = reason instanceof Error ? reason.message : String(reason);
  const buttons = ways.map(([label, action], index) => {
    const button = element('button', index === 0 ? 'primary' : '', label);
    button.addEventListener('click', action);
    return button;
  });
  const sheet = byId('cover');
  sheet.replaceChildren(element('p', isFault ? 'fault' : '', message), ...buttons);
  sheet.hidden = false;
  sheet.classList.toggle('failed', ways.length > 0);
}

/** Over the page: what it shows is not what is served here any more. */
export const coverReplaced = (): void =>
  cover('Another input is served here now: reload the page.', [
    ['Reload', () => location.reload()],
  ]);

export function uncover(): void {
  byId('cover').hidden = true;
  byId('main').setAttribute('aria-busy', 'false');
}
