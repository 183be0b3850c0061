// SPDX-License-Identifier: Apache-2.0
import './styles/base.css';
import './styles/page.css';
import './styles/timeline.css';
import { fetchReport, fetchSession } from './api/client';
import { LiveView } from './live_view';
import { StoredView } from './stored';
import { timelineLegend } from './timeline/legend';
import { cover } from './view/cover';
import { byId, setText } from './view/dom';
import { ThemeSwitch } from './view/theme';

async function start(): Promise<void> {
  const session = await fetchSession();
  const name = session.input.replace(/\/+$/, '').split('/').at(-1) ?? session.input;
  document.title = `${name} · Penumbra`;
  setText(byId('input-name'), name);
  byId('input-name').title = session.input;
  if (session.mode === 'live') setText(byId('mode'), 'live');
  byId('timeline-legend').replaceChildren(...timelineLegend());
  if (session.mode === 'live') new LiveView(session);
  else await new StoredView(session, await fetchReport()).start();
}

// The cookie holds the token from now on: out of the address, which is seen, kept and passed on.
if (new URLSearchParams(location.search).has('token'))
  history.replaceState(null, '', location.pathname + location.hash);

const run = (): void =>
  void start().catch((error: unknown) => cover(error, () => location.reload()));
new ThemeSwitch(byId<HTMLButtonElement>('theme'), () => document.dispatchEvent(new Event('theme')));
run();
