// SPDX-License-Identifier: Apache-2.0
// What the browser keeps for the user. Storage may be off: then choices hold until the page is left.

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
    // storage is off
  }
}
