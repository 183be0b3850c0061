// SPDX-License-Identifier: Apache-2.0
import { nothing } from '../model/format';
import type { Readout } from '../model/readout';
import { byId, setText } from './dom';

const fields = ['pixel', 'label', 'link', 'virtual', 'measured', 'difference'] as const;

/** null: the pointer is not over the image. */
export function showReadout(readout: Readout | null): void {
  for (const field of fields) setText(byId(`read-${field}`), readout?.[field] ?? nothing);
  byId('read-label').dataset['label'] = String(readout?.labelValue ?? '');
  byId('readout').classList.toggle('idle', readout === null);
}
