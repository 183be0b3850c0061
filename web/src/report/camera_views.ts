// SPDX-License-Identifier: Apache-2.0
// The report of a run with several cameras.
import type { Views } from '../api/cameras';
import { verdicts } from '../model/labels';
import { countOf } from '../model/timeline';
import { element } from '../view/dom';
import { barLegend, bars, headOf, hint, section, tableSection, verdictCell } from './parts';

export function cameraViewsPage(of: Views): Node[] {
  const all = of.frames.flatMap(({ targets }) => targets);
  const tracks = [...new Set(all.map(({ name }) => name))].map((name) => ({
    name,
    samples: all.filter((target) => target.name === name),
  }));
  const linkTo = (camera: string): Node =>
    Object.assign(element('a', '', camera), {
      href: `./${encodeURIComponent(camera)}/report.html`,
    });
  const counts = tracks.map(({ name, samples }) => [
    name,
    ...verdicts.map((verdict) => String(countOf(samples, verdict))),
    String(samples.filter((one) => one.contradiction).length),
  ]);
  return [
    headOf(`Targets over ${of.cameras.length} cameras`, of),
    ...tableSection('Targets', ['target', ...verdicts.map(verdictCell), 'contradictions'], counts),
    section(
      'Over time',
      hint('The images of all cameras, from left to right. ', ...barLegend()),
      ...tracks.flatMap(({ name, samples }) => [
        element('h3', '', name),
        bars([
          [element('b', '', 'all cameras'), samples.map(({ verdict }) => verdict)],
          ...of.cameras.map((camera) => {
            const views = samples.map((one) => one.views.find((view) => view.camera === camera));
            return [linkTo(camera), views.map((view) => view?.verdict ?? 'unknown')] as const;
          }),
        ]),
      ]),
    ),
  ];
}
