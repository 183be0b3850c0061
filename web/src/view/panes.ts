// SPDX-License-Identifier: Apache-2.0
// The borders between the page's panes can be moved; where they are is kept in the browser.
import { bindDrag } from './drag';
import { byId } from './dom';
import { readStored, store } from './stored';

const key = 'penumbra-panes';
const least = 12; // percent of the page that a pane keeps

interface Border {
  /** The custom property of the style sheet that holds the size. */
  readonly name: string;
  readonly axis: 'x' | 'y';
  /** The size is from the border to the end of the page, not from its start. */
  readonly fromEnd: boolean;
}

const borders: Readonly<Record<string, Border>> = {
  'scene-border': { name: '--scene-size', axis: 'x', fromEnd: false },
  'details-border': { name: '--details-size', axis: 'x', fromEnd: true },
  'timeline-border': { name: '--timeline-size', axis: 'y', fromEnd: true },
};

export function bindPanes(): void {
  const main = byId('main');
  const sizes = readStored<Record<string, number>>(key) ?? {};
  for (const [id, { name, axis, fromEnd }] of Object.entries(borders)) {
    const handle = byId(id);
    const place = (size: number): void => main.style.setProperty(name, `${size.toFixed(1)}%`);
    const kept = sizes[name];
    if (typeof kept === 'number') place(kept);
    const at = (): number => {
      const [outer, inner] = [main.getBoundingClientRect(), handle.getBoundingClientRect()];
      return axis === 'x'
        ? (100 * (inner.left + inner.width / 2 - outer.left)) / outer.width
        : (100 * (inner.top + inner.height / 2 - outer.top)) / outer.height;
    };
    const tell = (): void => handle.setAttribute('aria-valuenow', at().toFixed(0));
    bindDrag(handle, {
      axis,
      at,
      box: () => main.getBoundingClientRect(),
      move: (percent) => {
        const inside = Math.min(100 - least, Math.max(least, percent));
        sizes[name] = fromEnd ? 100 - inside : inside;
        place(sizes[name]);
        store(key, sizes);
        tell();
      },
    });
    handle.addEventListener('dblclick', () => {
      delete sizes[name];
      main.style.removeProperty(name);
      store(key, sizes);
      tell();
    });
    tell();
  }
}
