// SPDX-License-Identifier: Apache-2.0
import { readStored, store } from './stored';

const key = 'penumbra-theme';
const systemDark = window.matchMedia('(prefers-color-scheme: dark)');

/** Light or dark: the system's choice until the user makes one. */
export function bindTheme(button: HTMLElement, changed: () => void): void {
  const stored = readStored<string>(key);
  let isDark = stored === null ? null : stored === 'dark';
  const update = (): void => {
    const dark = isDark ?? systemDark.matches;
    document.documentElement.dataset['theme'] = dark ? 'dark' : 'light';
    button.setAttribute('aria-label', `Switch to ${dark ? 'light' : 'dark'} colours`);
    button.title = `Switch to ${dark ? 'light' : 'dark'} colours (T)`;
    changed();
  };
  button.addEventListener('click', () => {
    isDark = !(isDark ?? systemDark.matches);
    store(key, isDark ? 'dark' : 'light');
    update();
  });
  systemDark.addEventListener('change', update);
  update();
}
