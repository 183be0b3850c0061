// SPDX-License-Identifier: Apache-2.0
// The user's choices in localStorage. Without storage, choices last until the page is closed.

export function readStored<T>(key: string): T | null {
  try {
    return JSON.parse(localStorage.getItem(key) ?? 'null') as T | null;
  } catch {
    return null;
  }
}

export function store(key: string, value: unknown): void {
  try {
    localStorage.setItem(key, JSON.stringify(value));
  } catch {
    // no storage
  }
}
