// SPDX-License-Identifier: Apache-2.0
// The movable borders between the page's panes. The browser keeps their positions.
import { bindDrag } from './drag';
import { byId } from './dom';
import { readStored, store } from './stored';

const key = 'penumbra-panes';
const minSize = 12; // percent of the page

interface Border {
  /** The custom property of the style sheet for the size. */
  readonly name: string;
  readonly axis: 'x' | 'y';
  /** The size is the distance to the end of the page, not to its start. */
  readonly fromEnd: boolean;
}

const borders: Readonly<Record<string, Border>> = {
  'scene-border': { name: '--scene-size', axis: 'x', fromEnd: false },
  'details-border': { name: '--details-size', axis: 'x', fromEnd: true },
  'timeline-border': { name: '--timeline-size', axis: 'y', fromEnd: true },
};

const imageMargin = 18; // pixels: padding and border of the image's pane
const minScene = 0.32; // of the width of scene and image
const maxScene = 0.53;
let ratio = 0; // of the image, width to height; 0: no image

/** Gives the image's pane the width that its height allows, as long as no user moved the border. */
export function fitScene(imageRatio = ratio): void {
  ratio = imageRatio;
  const [scene, image] = [byId('scene').offsetWidth, byId('image').offsetWidth];
  if (ratio === 0 || scene === 0 || image === 0) return; // a phone shows one of them
  const both = scene + image;
  const wanted = both - byId('image-stage').offsetHeight * ratio - imageMargin;
  const width = Math.max(minScene * both, Math.min(wanted, maxScene * both));
  byId('main').style.setProperty('--scene-fit', `${Math.round(width)}px`);
}

export function bindPanes(): void {
  new ResizeObserver(() => requestAnimationFrame(() => fitScene())).observe(byId('image-stage'));
  const main = byId('main');
  const sizes = readStored<Record<string, number>>(key) ?? {};
  for (const [id, { name, axis, fromEnd }] of Object.entries(borders)) {
    const handle = byId(id);
    Object.assign(handle, {
      className: 'border',
      role: 'separator',
      ariaOrientation: axis === 'x' ? 'vertical' : 'horizontal',
      tabIndex: 0,
    });
    const at = (): number => {
      const [outer, inner] = [main.getBoundingClientRect(), handle.getBoundingClientRect()];
      return axis === 'x'
        ? (100 * (inner.left + inner.width / 2 - outer.left)) / outer.width
        : (100 * (inner.top + inner.height / 2 - outer.top)) / outer.height;
    };
    const update = (): void => {
      const size = sizes[name];
      if (size === undefined) main.style.removeProperty(name);
      else main.style.setProperty(name, `${size.toFixed(1)}%`);
      handle.setAttribute('aria-valuenow', at().toFixed(0));
    };
    const box = (): DOMRect => main.getBoundingClientRect();
    const move = (percent: number): void => {
      const inside = Math.min(100 - minSize, Math.max(minSize, percent));
      sizes[name] = fromEnd ? 100 - inside : inside;
      store(key, sizes);
      update();
    };
    bindDrag(handle, { axis, at, box, move });
    handle.addEventListener('dblclick', () => {
      delete sizes[name];
      store(key, sizes);
      update();
    });
    update();
  }
}
