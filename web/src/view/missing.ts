// SPDX-License-Identifier: Apache-2.0
import { byId, element, setText } from './dom';

/**
 * Sentences behind one button: what is not there, and the command that gives it.
 * @param level how much it matters: ok, warn or fault
 * @param count of them, those that are amiss
 */
export function showMissing(
  sentences: readonly string[],
  title: string,
  level: 'ok' | 'warn' | 'fault' = 'warn',
  count = sentences.length,
): void {
  const button = byId<HTMLButtonElement>('missing-button');
  const dialog = byId<HTMLDialogElement>('missing');
  button.hidden = sentences.length === 0;
  setText(button, level === 'ok' ? title : `${title} (${count})`);
  button.className = `chip ${level}`;
  const heading = element('h2', '', title);
  heading.id = 'missing-title';
  const close = element('button', 'primary', 'Close');
  close.addEventListener('click', () => dialog.close());
  const items = sentences.map((sentence) => element('li', '', ...withCommands(sentence)));
  dialog.replaceChildren(heading, element('ul', '', ...items), close);
  button.onclick = () => dialog.showModal();
}

/** What stands between backticks is a command. */
function withCommands(sentence: string): (Node | string)[] {
  return sentence.split('`').map((part, index) => (index % 2 ? element('code', '', part) : part));
}
