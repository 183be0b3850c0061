// SPDX-License-Identifier: Apache-2.0
import type { FrameReport } from '../api/types';
import { count, milliseconds, percent, stamp } from '../model/format';
import { stages } from '../timeline/timeline_view';
import { element, swatch } from './dom';
import { fact, factList } from './target_panel';

const shares = ['front', 'occluded', 'unknown', 'beyond'] as const; // of the robot's pixels

/** The frame's status in words, its pixels, its times. */
export function frameDetails(frame: FrameReport): HTMLElement {
  const body = element('div', 'frame-details');
  if (frame.status !== 'ok')
    body.append(element('p', 'fault', `${frame.status}: ${frame.message ?? 'no reason given'}`));
  const robot = frame.pixels['robot'] ?? null;
  const bar = element('div', 'share-bar');
  bar.setAttribute('aria-hidden', 'true');
  for (const name of shares) {
    const part = swatch(`--l-${name}`);
    part.style.flexGrow = String(robot ? (frame.pixels[name] ?? 0) : 0);
    bar.append(part);
  }
  body.append(bar);
  const pixels = [...shares, 'fringe', 'uncovered'].map((name) => {
    const value = frame.pixels[name] ?? null;
    const isShare = (shares as readonly string[]).includes(name);
    const share = robot && value !== null && isShare ? `  ${percent(value / robot)}` : '';
    return fact(
      name,
      name,
      value,
      `${count(value)}${share}`,
      name === 'uncovered' ? '' : `--l-${name}`,
    );
  });
  const times = stages.map((name, index) => {
    const value = frame.timing_ms?.[name] ?? null;
    return fact(name, name, value, milliseconds(value), `--series-${index}`);
  });
  const { stamp_ns, joint_age_ms } = frame;
  body.append(
    factList([fact('robot', 'robot pixels', robot, count(robot)), ...pixels]),
    element('h4', '', 'Times'),
    factList([
      fact('stamp_ns', 'stamp', stamp_ns, stamp(stamp_ns)),
      fact('joint_age_ms', 'joint age', joint_age_ms, milliseconds(joint_age_ms)),
      ...times,
    ]),
  );
  return body;
}
