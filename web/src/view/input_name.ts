// SPDX-License-Identifier: Apache-2.0
import type { Session } from '../api/types';
import { byId, setText } from './dom';

/** What is shown, in the page's bar and title. */
export function showInput({ input }: Session): void {
  const name = input.replace(/\/+$/, '').split('/').at(-1) ?? input;
  document.title = `${name} · Penumbra`;
  setText(byId('input-name'), name);
  byId('input-name').title = input;
}
