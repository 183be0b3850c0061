// SPDX-License-Identifier: Apache-2.0
import './styles/base.css';
import './styles/page.css';
import './styles/timeline.css';
import { fetchReport, fetchSession } from './api/client';
import { LiveView } from './live_view';
import { StoredView } from './stored_view';
import { timelineLegend } from './timeline/timeline_view';
import { byId } from './view/dom';
import { cover, openNotes, showInput } from './view/page';
import { bindPanes } from './view/panes';
import { bindTheme } from './view/theme';

async function start(): Promise<void> {
  const session = await fetchSession();
  showInput(session);
  byId('timeline-legend').replaceChildren(...timelineLegend());
  bindPanes();
  if (session.mode === 'live') {
    new LiveView(session);
    return;
  }
  const report = await fetchReport();
  // The missing data has to be that of all frames of the report.
  await new StoredView(session.complete ? session : await fetchSession(), report).start();
}

// A cookie keeps the token: remove it from the address, which users copy.
if (new URLSearchParams(location.search).has('token'))
  history.replaceState(null, '', location.pathname + location.hash);

bindTheme(byId('theme'), () => document.dispatchEvent(new Event('theme')));
byId('notes-button').addEventListener('click', () => openNotes(byId('notes').hidden));
start().catch((error: unknown) => cover(error, [['Try again', () => location.reload()]]));
