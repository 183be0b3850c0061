// SPDX-License-Identifier: Apache-2.0

export type Theme = 'light' | 'dark';

const key = 'penumbra-theme';
const dark = window.matchMedia('(prefers-color-scheme: dark)');

function stored(): Theme | null {
  try {
    const value = localStorage.getItem(key);
    return value === 'light' || value === 'dark' ? value : null;
  } catch {
    return null; // storage is off
  }
}

/** Light or dark: as the system says, until the user chooses. */
export class ThemeSwitch {
  private chosen = stored();

  constructor(
    private readonly button: HTMLButtonElement,
    private readonly changed: () => void,
  ) {
    button.addEventListener('click', () => this.toggle());
    dark.addEventListener('change', () => this.apply());
    this.apply();
  }

  get theme(): Theme {
    return this.chosen ?? (dark.matches ? 'dark' : 'light');
  }

  toggle(): void {
    this.chosen = this.theme === 'dark' ? 'light' : 'dark';
    try {
      localStorage.setItem(key, this.chosen);
    } catch {
      // storage is off: the choice holds until the page is left
    }
    this.apply();
  }

  private apply(): void {
    document.documentElement.dataset['theme'] = this.theme;
    const other = this.theme === 'dark' ? 'light' : 'dark';
    this.button.setAttribute('aria-label', `Switch to ${other} colours`);
    this.button.title = `Switch to ${other} colours (T)`;
    this.changed();
  }
}

/** A custom property of the style sheet. */
export const styleValue = (name: string): string =>
  getComputedStyle(document.documentElement).getPropertyValue(name).trim();
