// SPDX-License-Identifier: Apache-2.0
// Simulates live frames from a stored one, with any age, rate, verdict or damage.

/** Returns the JSON of a packet, read as documented, and the bytes of its parts. */
export function headOf(packet) {
  const length = packet.readUInt32LE(0);
  const head = JSON.parse(packet.subarray(4, 4 + length).toString());
  return { head, parts: packet.subarray(4 + length) };
}

function packetOf(head, parts) {
  const json = Buffer.from(JSON.stringify(head));
  const length = Buffer.alloc(4);
  length.writeUInt32LE(json.length);
  return Buffer.concat([length, json, parts]);
}

/**
 * Makes a page live that is opened next.
 * @param url server of a recording, whose robot and frame 3 are shown
 */
export async function playLive(page, url) {
  const query = '/api/frames/3/packet?with=color,labels,links,cloud,vdi,depth&step=6';
  const stored = Buffer.from(await (await fetch(new URL(query, url))).arrayBuffer());
  const { head, parts } = headOf(stored);
  const session = await (await fetch(new URL('/api/session', url))).json();
  const state = {
    sent: 0,
    requested: 0,
    connections: 0,
    socket: null,
    missing: [],
    answers: true,
    parts: [],
    changed: () => {}, // a connection or a request came
  };
  const until = async (isTrue) => {
    while (!isTrue()) await new Promise((resolve) => (state.changed = resolve));
  };
  await page.route('**/api/session', (route) => {
    if (!state.answers) return route.abort('timedout');
    return route.fulfill({
      json: {
        ...session,
        mode: 'live',
        complete: false,
        parts: session.parts.filter((part) => part !== 'overlay'),
        missing: state.missing,
        diagnostics: [],
      },
    });
  });
  await page.routeWebSocket('**/api/live', (socket) => {
    state.socket = socket;
    ++state.connections;
    state.changed();
    socket.onMessage((text) => {
      const message = JSON.parse(text);
      if (message.type === 'want') state.parts = message.with;
      else if (message.type === 'ready') ++state.requested;
      state.changed();
    });
  });

  state.connected = (times) => until(() => state.connections >= times);

  state.isAsked = () => until(() => state.requested > state.sent);

  /** Sends a frame after the page requested one. */
  state.send = async ({ age = 20, rate = 10, damage = false, verdict } = {}) => {
    await state.isAsked();
    const targets = head.frame.targets.map((target) => ({
      ...target,
      verdict: verdict ?? target.verdict,
    }));
    const index = ++state.sent;
    const live = { age_ms: age, dropped: 0, rate_hz: rate, missing: [], diagnostics: [] };
    const packet = packetOf({ ...head, frame: { ...head.frame, index, targets }, live }, parts);
    state.socket.send(damage ? packet.subarray(0, packet.length - 5) : packet);
    return index;
  };
  return state;
}
