// SPDX-License-Identifier: Apache-2.0
import { byId, element } from './dom';

/**
 * Over the page: why there is nothing to see, and a way on.
 * @param back to what was shown before, where something was
 */
export function cover(error: unknown, retry: () => void, back?: () => void): void {
  const message = error instanceof Error ? error.message : String(error);
  show(message, 'Try again', retry, back);
}

/** Over the page: what it shows is not what is served here any more. */
export const coverReplaced = (): void =>
  show('Another input is served here now: reload the page.', 'Reload', () => location.reload());

function show(message: string, label: string, action: () => void, back?: () => void): void {
  const button = element('button', 'primary', label);
  button.addEventListener('click', action);
  const sheet = byId('cover');
  sheet.replaceChildren(element('p', 'fault', message), button);
  if (back) {
    const close = element('button', '', 'Back to the frame before');
    close.addEventListener('click', back);
    sheet.append(close);
  }
  sheet.hidden = false;
  sheet.classList.add('failed');
}

/**
 * Over the page: something is still to come.
 * @param isFault it may never come
 */
export function coverWaiting(text: string, isFault = false): void {
  const sheet = byId('cover');
  sheet.replaceChildren(element('p', isFault ? 'fault' : '', text));
  sheet.hidden = false;
  sheet.classList.remove('failed');
}

export function uncover(): void {
  byId('cover').hidden = true;
  byId('main').setAttribute('aria-busy', 'false');
}
