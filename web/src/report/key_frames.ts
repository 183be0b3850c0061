// SPDX-License-Identifier: Apache-2.0
import { element } from '../view/dom';

export interface KeyFrame {
  /** Of the report's frames, from 0. */
  readonly index: number;
  /** A data: address. */
  readonly image: string;
}

/** The pictures; each opens its frame in the timeline. */
export function keyFrames(
  pictures: readonly KeyFrame[],
  captionOf: (picture: KeyFrame) => readonly (Node | string)[],
  seek: (frame: number) => void,
): HTMLElement {
  const gallery = element('div', 'gallery');
  for (const shown of pictures) {
    const caption = element('figcaption', '', ...captionOf(shown));
    const picture = element('img');
    picture.src = shown.image;
    picture.alt = `overlay of ${caption.firstElementChild?.textContent ?? ''}`;
    const open = element('button', 'picture', picture);
    open.title = 'Show in the timeline';
    open.addEventListener('click', () => seek(shown.index));
    gallery.append(element('figure', 'panel', open, caption));
  }
  return gallery;
}
