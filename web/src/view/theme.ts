// SPDX-License-Identifier: Apache-2.0
import { readStored, store } from './stored';

const key = 'penumbra-theme';
const dark = window.matchMedia('(prefers-color-scheme: dark)');

/** Light or dark: as the system says, until the user chooses. */
export function bindTheme(button: HTMLButtonElement, changed: () => void): void {
  const stored = readStored<string>(key);
  let chosen = stored === 'light' || stored === 'dark' ? stored : null;
  const theme = (): string => chosen ?? (dark.matches ? 'dark' : 'light');
  const other = (): string => (theme() === 'dark' ? 'light' : 'dark');
  const apply = (): void => {
    document.documentElement.dataset['theme'] = theme();
    button.setAttribute('aria-label', `Switch to ${other()} colours`);
    button.title = `Switch to ${other()} colours (T)`;
    changed();
  };
  button.addEventListener('click', () => {
    chosen = other();
    store(key, chosen);
    apply();
  });
  dark.addEventListener('change', apply);
  apply();
}

/** A custom property of the style sheet. */
export const styleValue = (name: string): string =>
  getComputedStyle(document.documentElement).getPropertyValue(name).trim();
