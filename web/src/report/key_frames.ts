// SPDX-License-Identifier: Apache-2.0
import type { Report } from '../api/types';
import { verdictOf } from '../model/labels';
import { element } from '../view/dom';
import { verdictIcon } from '../view/verdict_icon';

export interface KeyFrame {
  /** Of the report's frames, from 0. */
  readonly index: number;
  /** A data: address. */
  readonly image: string;
}

export function keyFrames(
  pictures: readonly KeyFrame[],
  report: Report,
  seek: (frame: number) => void,
): HTMLElement {
  const gallery = element('div', 'gallery');
  for (const { index, image } of pictures) {
    const frame = report.frames[index];
    if (!frame) continue;
    const picture = element('img');
    picture.src = image;
    picture.alt = `overlay of frame ${frame.index}`;
    const open = element('button', 'picture', picture);
    open.title = 'Show in the timeline';
    open.addEventListener('click', () => seek(index));
    const caption = element('figcaption', '', element('b', '', `frame ${frame.index}`));
    for (const { name, verdict } of frame.targets)
      caption.append(element('span', 'legend-entry', verdictIcon(verdictOf(verdict)), name));
    gallery.append(element('figure', 'panel', open, caption));
  }
  return gallery;
}
