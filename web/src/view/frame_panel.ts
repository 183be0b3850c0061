// SPDX-License-Identifier: Apache-2.0
import type { Calibration, FrameReport } from '../api/types';
import { count, milliseconds, movedText, percent, stamp, turnedText } from '../model/format';
import { stages } from '../timeline/timeline_view';
import { element, swatch } from './dom';
import { fact, factList } from './target_panel';

const robotLabels = ['front', 'occluded', 'unknown', 'beyond'];
const pointLabels = ['front', 'occluded', 'beyond']; // of points towards the robot

/** Returns the frame's status, counts of pixels or points, and times. */
export function frameDetails(frame: FrameReport): HTMLElement {
  const { status, message, points, timing_ms, stamp_ns, joint_age_ms } = frame;
  const numbers = points ?? frame.pixels ?? {};
  const ofRobot = points ? pointLabels : robotLabels;
  const others = points ? ['fringe', 'unknown', 'clear'] : ['fringe', 'uncovered'];
  const robot = points
    ? ofRobot.reduce((sum, name) => sum + (points[name] ?? 0), 0)
    : (numbers['robot'] ?? null);
  const bar = element('div', 'fraction-bar');
  for (const name of ofRobot) {
    const part = swatch(`--l-${name}`);
    part.style.flexGrow = String(robot ? (numbers[name] ?? 0) : 0);
    bar.append(part);
  }
  const counts = [...ofRobot, ...others].map((name) => {
    const value = numbers[name] ?? null;
    const isFraction = robot && value !== null && ofRobot.includes(name);
    const text = `${count(value)}${isFraction ? `  ${percent(value / robot)}` : ''}`;
    const hasColor = name !== 'uncovered' && name !== 'clear';
    return fact(name, name, value, text, hasColor ? `--l-${name}` : '');
  });
  const robotName = points ? 'points towards the robot' : 'robot pixels';
  const times = stages.map((name, index) => {
    const value = timing_ms?.[name] ?? null;
    return fact(name, name, value, milliseconds(value), `--series-${index}`);
  });
  const attached = Object.keys(frame.attached ?? {});
  const carried = attached.length
    ? [fact('attached', 'attached', attached, attached.join(', '))]
    : [];
  const body = element('div', 'frame-details');
  if (status !== 'ok')
    body.append(element('p', 'fault', message ? `${status}: ${message}` : status));
  body.append(
    bar,
    factList([fact('robot', robotName, robot, count(robot)), ...counts, ...carried]),
    element('h4', '', points ? 'Time' : 'Times'),
    factList([
      fact('stamp_ns', 'stamp', stamp_ns, stamp(stamp_ns)),
      ...(points
        ? []
        : [fact('joint_age_ms', 'joint age', joint_age_ms, milliseconds(joint_age_ms)), ...times]),
    ]),
  );
  return body;
}

/**
 * Returns how far the camera is from its calibration; null: not known.
 * @param calibrating how far a new calibration is; empty: none was begun
 */
export const calibrationDetails = (
  calibration: Calibration | null,
  calibrating: string,
): HTMLElement =>
  element(
    'div',
    'frame-details',
    element('h4', '', 'Camera, from its calibration'),
    factList([
      fact('moved_mm', 'moved', calibration?.moved_mm, movedText(calibration)),
      fact('turned_degrees', 'turned', calibration?.turned_degrees, turnedText(calibration)),
    ]),
    ...(calibrating ? [element('p', 'calibrating', `New calibration: ${calibrating}`)] : []),
  );
