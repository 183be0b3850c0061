// SPDX-License-Identifier: Apache-2.0
// The report of a command, in one file. The keys of its JSON tell which command it is.
import '../styles/base.css';
import '../styles/timeline.css';
import '../styles/report.css';
import type { Views } from '../api/cameras';
import { parseJson } from '../api/packet';
import type { Report } from '../api/types';
import { byId } from '../view/dom';
import { calibrationPage, type CalibrationReport } from './calibration';
import { cameraViewsPage } from './camera_views';
import { lookAheadPage, type LookAhead } from './look_ahead';
import type { Picture } from './parts';
import { ReportPage } from './report_page';
import { viewPlanningPage, type ViewPlan } from './view_planning';

const embedded = <T>(id: string): T => parseJson<T>(byId(id).textContent ?? 'null');

type AnyReport = Report | Views | CalibrationReport | LookAhead | ViewPlan;
const host = byId('report');
const pictures = embedded<readonly Picture[]>('penumbra-pictures');
const report = embedded<AnyReport | null>('penumbra-report');

function pageOf(of: AnyReport): readonly Node[] {
  if ('T_parent_camera' in of) return calibrationPage(of, pictures);
  if ('motions' in of) return lookAheadPage(of, pictures);
  if ('candidates' in of) return viewPlanningPage(of);
  if ('cameras' in of) return cameraViewsPage(of);
  return new ReportPage(of, pictures).content;
}

if (report) {
  host.replaceChildren(...pageOf(report));
  document.title = `${host.querySelector('h1')?.textContent}: ${report.input}`;
} else host.textContent = 'This file contains no report.';
