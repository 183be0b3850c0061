// SPDX-License-Identifier: Apache-2.0
// Frame and target in the address, so that a reload or a link leads to the same place.

export function fragmentState(): { frame: number; target: string | null } {
  const state = new URLSearchParams(location.hash.slice(1));
  const frame = Number.parseInt(state.get('frame') ?? '0', 10);
  return { frame: Number.isFinite(frame) ? frame : 0, target: state.get('target') };
}

let timer = 0;

export function setFragment(frame: number, target: string | null): void {
  window.clearTimeout(timer);
  timer = window.setTimeout(() => {
    const state = new URLSearchParams({ frame: String(frame) });
    if (target) state.set('target', target);
    history.replaceState(null, '', `#${state.toString()}`);
  }, 300);
}
