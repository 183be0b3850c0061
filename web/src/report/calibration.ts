// SPDX-License-Identifier: Apache-2.0
// The report of a calibration.
import { degrees, estimate, percent, scaled, type Estimate } from '../model/format';
import { element } from '../view/dom';
import {
  gallery,
  headOf,
  hint,
  notes,
  section,
  tableSection,
  type Origin,
  type Picture,
} from './parts';

/** calibration.json; an estimate is null or absent if it was not made. */
export interface CalibrationReport extends Origin {
  readonly faults: readonly string[];
  readonly notes: readonly string[];
  readonly advice: string;
  readonly camera_parent: string;
  readonly T_parent_camera: readonly (readonly number[])[];
  /** x y z qx qy qz qw. */
  readonly pose: readonly number[];
  readonly position_error_95_m: number | null;
  readonly rotation_error_95_rad: number | null;
  readonly depth_offset_m: Estimate | null;
  readonly depth_scale: Estimate | null;
  readonly outline_px: Estimate;
  readonly frames: readonly {
    readonly index: number;
    readonly used: boolean;
    readonly agreeing: number | null;
    readonly residual_m: number | null;
    readonly outline_px: number | null;
  }[];
  readonly link_residuals_m: Readonly<Record<string, number>>;
  readonly focal?: { readonly fx_relative: Estimate; readonly fy_relative: Estimate };
  readonly joint_offsets?: Readonly<Record<string, Estimate>>;
  readonly time_offset_s?: Estimate;
  readonly masks?: {
    readonly overlap: number;
    readonly depth_shift_right_px: Estimate | null;
    readonly depth_shift_down_px: Estimate | null;
  };
}

export function calibrationPage(of: CalibrationReport, pictures: readonly Picture[]): Node[] {
  const hasDepth = of.depth_offset_m !== null;
  const frames = of.frames.map((frame) => [
    `${frame.index}${frame.used ? '' : ' (left out)'}`,
    percent(frame.agreeing, 0),
    scaled(frame.outline_px, 1, 1, ' px'),
    ...(hasDepth ? [scaled(frame.residual_m, 1e3, 1, ' mm')] : []),
  ]);
  const fits = hasDepth
    ? ['robot’s pixels at its depth', 'depth’s edge', 'from its surface']
    : ['overlap with the mask', 'mask’s edge'];
  const links = Object.entries(hasDepth ? of.link_residuals_m : {});
  const colors = hasDepth
    ? 'Its pixels are white where the measured point is on its surface, red where it is 2 cm or ' +
      'more behind, blue where it is before. The depth offset and scale above are taken off.'
    : 'The masks are grey.';
  return [
    headOf('Calibration', of),
    ...of.faults.map((fault) => element('p', 'diagnosis', `Not calibrated: ${fault}`)),
    ...notes([...of.notes, of.advice].filter(Boolean)),
    ...tableSection('Result', ['estimate', 'value'], estimates(of)),
    ...tableSection('By frame', ['frame', ...fits], frames),
    ...tableSection(
      'By link',
      ['link', 'median distance behind its surface'],
      links.map(([link, residual]) => [link, scaled(residual, 1e3, 1, ' mm')]),
    ),
    section(
      'Pictures',
      hint('Of the first guess, if there was one, and of the result. Green: the robot. ', colors),
      gallery(pictures),
    ),
  ];
}

/** Returns the estimates that were made, with twice their standard deviations. */
function estimates(of: CalibrationReport): string[][] {
  const { focal, masks, pose } = of;
  const listed = (values: readonly number[], digits: number): string =>
    values.map((value) => value.toFixed(digits)).join(', ');
  const shift = [masks?.depth_shift_right_px, masks?.depth_shift_down_px];
  const rows: (readonly [string, string | null])[] = [
    [`camera’s position in ${of.camera_parent}`, `${listed(pose.slice(0, 3), 5)} m`],
    ['quaternion xyzw', listed(pose.slice(3), 6)],
    [
      '95 % region',
      `${scaled(of.position_error_95_m, 1e3, 1, ' mm')}, ` +
        scaled(of.rotation_error_95_rad, degrees, 2, '°'),
    ],
    ['outline is larger by', estimate(of.outline_px, 1, 1, ' px')],
    ['depth offset', estimate(of.depth_offset_m, 1e3, 1, ' mm')],
    ['depth scale', estimate(of.depth_scale, 100, 2, ' %')],
    ['overlap with the masks', masks ? percent(masks.overlap) : null],
    ['depth image right of the colour image', estimate(shift[0], 1, 1, ' px')],
    ['depth image below the colour image', estimate(shift[1], 1, 1, ' px')],
    ['focal length fx is longer by', estimate(focal?.fx_relative, 100, 2, ' %')],
    ['focal length fy is longer by', estimate(focal?.fy_relative, 100, 2, ' %')],
    ['time offset', estimate(of.time_offset_s, 1e3, 1, ' ms')],
    ...Object.entries(of.joint_offsets ?? {}).map(
      ([joint, offset]) => [`offset of ${joint}`, estimate(offset, degrees, 2, '°')] as const,
    ),
  ];
  return rows.flatMap(([name, value]) => (value === null ? [] : [[name, value]]));
}
