// SPDX-License-Identifier: Apache-2.0
// What the reports of all commands consist of.
import type { Verdict } from '../api/types';
import { verdictNames, verdicts } from '../model/labels';
import { condense, runsOf } from '../model/timeline';
import { element } from '../view/dom';
import { verdictIcon } from '../view/verdict_icon';

export interface Picture {
  /** Of the frame, or of the motion, that it shows. */
  readonly index: number;
  /** A data: URL. */
  readonly image: string;
  readonly caption: string;
}

/** What the JSON of each command begins with. */
export interface Origin {
  readonly penumbra: string;
  readonly input: string;
}

export const headOf = (title: string, { input, penumbra }: Origin, more = ''): HTMLElement =>
  element(
    'header',
    '',
    element('h1', '', title),
    element('p', 'input', input),
    element('p', 'hint', `Penumbra ${penumbra}${more}`),
  );

export const section = (title: string, ...content: Node[]): HTMLElement =>
  element('section', '', element('h2', '', title), ...content);

export const card = (title: string, content: Node): HTMLElement =>
  element('div', 'panel card', element('h3', '', title), content);

export const hint = (...content: (Node | string)[]): HTMLElement =>
  element('p', 'hint', ...content);

export function notes(lines: readonly string[]): HTMLElement[] {
  if (lines.length === 0) return [];
  const made = section('Notes', element('ul', '', ...lines.map((line) => element('li', '', line))));
  made.className = 'notes';
  return [made];
}

export type Cell = string | readonly (Node | string)[];

/** Aligns columns of numbers to the right, and mutes zeros. */
export function table(head: readonly Cell[], rows: readonly (readonly Cell[])[]): HTMLElement {
  const isNumber = (cell?: Cell): boolean =>
    typeof cell === 'string' && /^(–|-?[\d.]+( \D{1,2})?)$/.test(cell);
  const classes = head.map((_, i) => (rows.every((row) => isNumber(row[i])) ? '' : 'text'));
  const rowOf = (tag: 'th' | 'td', cells: readonly Cell[]): HTMLElement => {
    const made = cells.map((cell, i) => {
      const className = `${classes[i] ?? ''} ${i > 0 && cell === '0' ? 'none' : ''}`.trim();
      return element(tag, className, ...(typeof cell === 'string' ? [cell] : cell));
    });
    return element('tr', '', ...made);
  };
  return element('table', '', rowOf('th', head), ...rows.map((row) => rowOf('td', row)));
}

export const tableCard = (...of: Parameters<typeof table>): HTMLElement =>
  element('div', 'panel card scroll', table(...of));

/** Returns no section if the table has no rows. */
export const tableSection = (title: string, ...of: Parameters<typeof table>): HTMLElement[] =>
  of[1].length > 0 ? [section(title, tableCard(...of))] : [];

/** Returns a table that is closed at first. */
export const tableDetails = (title: string, ...of: Parameters<typeof table>): HTMLElement =>
  element('details', 'panel card scroll', element('summary', '', title), table(...of));

export const verdictCell = (verdict: Verdict): Cell => [
  verdictIcon(verdict),
  verdictNames[verdict],
];

/** From the least to the most that is seen. */
const bySight = ['unknown', 'out_of_view', 'held', 'hidden', 'partial', 'visible'];
const sees = (verdict: Verdict): number => bySight.indexOf(verdict);
export const lessSeen = (a: Verdict, b: Verdict): Verdict => (sees(b) < sees(a) ? b : a);
export const moreSeen = (a: Verdict, b: Verdict): Verdict => (sees(b) > sees(a) ? b : a);

/** More verdicts than this share columns of a bar; each shows the one in which least is seen. */
export const mostColumns = 500;

/** Draws verdicts from left to right; a bar for each name. */
export function bars(rows: readonly (readonly [Node | string, readonly Verdict[]])[]): HTMLElement {
  const cells = rows.flatMap(([name, all]) => {
    const runs = runsOf(condense(all, mostColumns, lessSeen));
    const bar = element('div', 'verdict-bar');
    for (const { from, to, value } of runs) {
      const part = element('i', `fill ${value}`);
      part.style.flexGrow = String(to - from);
      part.title = verdictNames[value];
      bar.append(part);
    }
    bar.role = 'img';
    bar.ariaLabel = runs.map(({ value }) => verdictNames[value]).join(', ');
    return [element('span', '', name), bar];
  });
  return element('div', 'panel card bars', ...cells);
}

export const barLegend = (): HTMLElement[] =>
  verdicts.map((verdict) =>
    element('span', 'legend-entry', element('i', `swatch fill ${verdict}`), verdictNames[verdict]),
  );

export const gallery = (pictures: readonly Picture[]): HTMLElement =>
  element(
    'div',
    'gallery large',
    ...pictures.map(({ image, caption }) => {
      const picture = Object.assign(element('img'), { src: image, alt: caption });
      return element('figure', 'panel', picture, element('figcaption', '', caption));
    }),
  );
