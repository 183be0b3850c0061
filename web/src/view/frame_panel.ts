// SPDX-License-Identifier: Apache-2.0
import type { FrameReport } from '../api/types';
import { count, milliseconds, percent, stamp } from '../model/format';
import { stages } from '../timeline/timeline_view';
import { element } from './dom';
import { factList } from './target_panel';

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
    const part = element('i', `l-${name}`);
    part.style.flexGrow = String(robot ? (frame.pixels[name] ?? 0) : 0);
    bar.append(part);
  }
  body.append(bar);
  const pixels = [...shares, 'fringe', 'uncovered'].map((name) => {
    const value = frame.pixels[name] ?? null;
    const isShare = (shares as readonly string[]).includes(name);
    const share = robot && value !== null && isShare ? `  ${percent(value / robot)}` : '';
    const color = name === 'uncovered' ? '' : `l-${name}`;
    return { key: name, name, text: `${count(value)}${share}`, value, color };
  });
  const times = stages.map((name, index) => {
    const value = frame.timing_ms?.[name] ?? null;
    return { key: name, name, text: milliseconds(value), value, color: `series-${index}` };
  });
  body.append(
    factList([{ key: 'robot', name: 'robot pixels', text: count(robot), value: robot }, ...pixels]),
    element('h4', '', 'Times'),
    factList([
      { key: 'stamp_ns', name: 'stamp', text: stamp(frame.stamp_ns), value: frame.stamp_ns },
      {
        key: 'joint_age_ms',
        name: 'joint age',
        text: milliseconds(frame.joint_age_ms),
        value: frame.joint_age_ms,
      },
      ...times,
    ]),
  );
  return body;
}
