// SPDX-License-Identifier: Apache-2.0
// One file that tells a run or an experiment: summary, targets over time, key frames. Opens from the
// disk, prints.
import '../styles/base.css';
import '../styles/targets.css';
import '../styles/timeline.css';
import '../styles/report.css';
import '../styles/experiment.css';
import { parseJson } from '../api/json';
import type { Report } from '../api/types';
import { ExperimentPage } from '../experiment/experiment_page';
import type { Experiment, Metrics } from '../experiment/types';
import { byId } from '../view/dom';
import type { KeyFrame } from './key_frames';
import { ReportPage } from './report_page';

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
const experiment = embedded<Experiment | null>('penumbra-experiment');
if (experiment) {
  new ExperimentPage(host, embedded<Metrics>('penumbra-report'), experiment, pictures);
} else {
  const report = embedded<Report | null>('penumbra-report');
  if (report) new ReportPage(host, report, pictures);
  else host.textContent = 'There is no report in this file.';
}
