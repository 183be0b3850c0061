// SPDX-License-Identifier: Apache-2.0
// The report of a run in one file: summary, targets over time, key frames. It opens from the disk and
// prints.
import '../styles/base.css';
import '../styles/timeline.css';
import '../styles/report.css';
import { parseJson } from '../api/json';
import type { Report } from '../api/types';
import { byId } from '../view/dom';
import { ReportPage, type KeyFrame } from './report_page';

function embedded<T>(id: string): T {
  return parseJson<T>(byId(id).textContent ?? 'null');
}

const dark = window.matchMedia('(prefers-color-scheme: dark)');
const applyTheme = (): void => {
  document.documentElement.dataset['theme'] = dark.matches ? 'dark' : 'light';
};
dark.addEventListener('change', applyTheme);
applyTheme();

const host = byId('report');
const pictures = embedded<readonly KeyFrame[]>('penumbra-frames');
const report = embedded<Report | null>('penumbra-report');
if (report) new ReportPage(host, report, pictures);
else host.textContent = 'There is no report in this file.';
