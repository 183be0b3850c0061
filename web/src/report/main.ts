// SPDX-License-Identifier: Apache-2.0
// The report of a run, in one file: summary, timeline, targets, key frames.
import '../styles/base.css';
import '../styles/timeline.css';
import '../styles/report.css';
import { parseJson } from '../api/packet';
import type { Report } from '../api/types';
import { byId } from '../view/dom';
import { ReportPage, type KeyFrame } from './report_page';

const embedded = <T>(id: string): T => parseJson<T>(byId(id).textContent ?? 'null');

const host = byId('report');
const images = embedded<readonly KeyFrame[]>('penumbra-frames');
const report = embedded<Report | null>('penumbra-report');
if (report) new ReportPage(host, report, images);
else host.textContent = 'This file contains no report.';
