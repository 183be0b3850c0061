// SPDX-License-Identifier: Apache-2.0
import './styles/base.css';
import './styles/page.css';
import './styles/targets.css';
import './styles/timeline.css';
import { fetchReport, fetchSession } from './api/client';
import type { Session } from './api/types';
import { LiveView } from './live_view';
import { StoredView } from './stored';
import { timelineLegend } from './timeline/legend';
import { cover } from './view/cover';
import { byId } from './view/dom';
import { showInput } from './view/input_name';
import { ThemeSwitch } from './view/theme';

/** What a session says was missing has to be of all frames that the report has. */
async function openStored(session: Session): Promise<void> {
  const report = await fetchReport();
  await new StoredView(session.complete ? session : await fetchSession(), report).start();
}

async function start(): Promise<void> {
  const session = await fetchSession();
  showInput(session);
  byId('timeline-legend').replaceChildren(...timelineLegend());
  if (session.mode === 'live') new LiveView(session);
  else await openStored(session);
}

// The cookie holds the token from now on: out of the address, which is seen, kept and passed on.
if (new URLSearchParams(location.search).has('token'))
  history.replaceState(null, '', location.pathname + location.hash);

const run = (): void =>
  void start().catch((error: unknown) => cover(error, () => location.reload()));
new ThemeSwitch(byId<HTMLButtonElement>('theme'), () => document.dispatchEvent(new Event('theme')));
run();
