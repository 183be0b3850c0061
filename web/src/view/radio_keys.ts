// SPDX-License-Identifier: Apache-2.0

/** By which place a key leads on; null: it is none of these. */
function placeOf(key: string, at: number, count: number): number | null {
  switch (key) {
    case 'ArrowRight':
    case 'ArrowDown':
      return (at + 1) % count;
    case 'ArrowLeft':
    case 'ArrowUp':
      return (at - 1 + count) % count;
    case 'Home':
      return 0;
    case 'End':
      return count - 1;
    default:
      return null;
  }
}

/** Marks the one of a group that is chosen: tab leads to that one, arrows to the others. */
export function markChosen(group: HTMLElement, attribute: string, chosen: Element): void {
  for (const one of group.querySelectorAll('button')) {
    one.setAttribute(attribute, String(one === chosen));
    one.tabIndex = one === chosen ? 0 : -1;
  }
}

/** Arrow keys, Home and End choose another one of a group of radio buttons or tabs. */
export function bindRadioKeys(group: HTMLElement): void {
  group.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const all = [...group.querySelectorAll('button')];
    const to = placeOf(event.key, all.indexOf(event.target as HTMLButtonElement), all.length);
    const next = to === null ? undefined : all[to];
    if (!next) return;
    event.preventDefault();
    event.stopPropagation(); // elsewhere they step
    next.focus();
    next.click();
  });
}
