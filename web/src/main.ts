// SPDX-License-Identifier: Apache-2.0
import './styles/base.css';
import './styles/page.css';
import './styles/timeline.css';
import { fetchReport, fetchSession } from './api/client';
import type { Session } from './api/types';
import { LiveView } from './live_view';
import { StoredView } from './stored';
import { timelineLegend } from './timeline/timeline_view';
import { byId } from './view/dom';
import { cover, showInput } from './view/page';
import { bindPanes } from './view/panes';
import { bindTheme } from './view/theme';

/** What a session says was missing has to be of all frames that the report has. */
async function openStored(session: Session): Promise<void> {
  const report = await fetchReport();
  await new StoredView(session.complete ? session : await fetchSession(), report).start();
}

async function start(): Promise<void> {
  const session = await fetchSession();
  showInput(session);
  byId('timeline-legend').replaceChildren(...timelineLegend());
  bindPanes();
  if (session.mode === 'live') new LiveView(session);
  else await openStored(session);
}

// The cookie holds the token from now on: out of the address, which is seen, kept and passed on.
if (new URLSearchParams(location.search).has('token'))
  history.replaceState(null, '', location.pathname + location.hash);

bindTheme(byId<HTMLButtonElement>('theme'), () => document.dispatchEvent(new Event('theme')));
start().catch((error: unknown) => cover(error, [['Try again', () => location.reload()]]));
