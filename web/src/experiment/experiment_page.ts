// SPDX-License-Identifier: Apache-2.0
import { percent, seconds } from '../model/format';
import { verdictNames, verdictOf } from '../model/labels';
import { keyFrames, type KeyFrame } from '../report/key_frames';
import { card, onFrameKeys, section, tile, timelinePanel } from '../report/parts';
import { targetsTable } from '../report/targets_table';
import { element } from '../view/dom';
import { factList } from '../view/target_panel';
import { verdictIcon } from '../view/verdict_icon';
import { lineSwatch, methodLegend } from './error_chart';
import { errorText, ExperimentTimeline, laneTitle } from './experiment_timeline';
import { laneResults } from './results';
import type { Experiment, Metrics } from './types';

const confidenceNote =
  'Values are over all seeds; small: 95 % confidence, by a bootstrap over seeds; of counts below ' +
  '10 and of shares of seeds, exact; of a single seed, none.';

/** The whole page; a frame, a kind of detection and a method are chosen in it. */
export class ExperimentPage {
  private frame: number;
  private lane: string;
  private method: string;
  private readonly details = element('div', 'report-details experiment-details');
  private readonly timeline: ExperimentTimeline;

  constructor(
    host: HTMLElement,
    metrics: Metrics,
    private readonly experiment: Experiment,
    pictures: readonly KeyFrame[],
  ) {
    const { run, methods } = experiment;
    this.lane = Object.keys(run.lanes)[0] ?? '';
    this.method = methods.at(-1)?.key ?? '';
    this.frame = pictures[0]?.index ?? 0;
    const legend = methodLegend(methods, (key) => this.chooseMethod(key));
    const [chart, panel] = timelinePanel(legend);
    this.timeline = new ExperimentTimeline(chart, experiment, {
      seek: (frame) => this.seek(frame),
      choose: (lane) => this.chooseLane(lane),
    });
    const frames = { numberOf: String, seek: (frame: number) => this.seek(frame) };
    host.replaceChildren(
      headOf(metrics, experiment),
      tilesOf(metrics, experiment),
      section(
        'Results',
        element('p', 'hint', confidenceNote),
        ...Object.entries(metrics.detections).map(([key, lane]) =>
          laneResults(experiment, key, lane),
        ),
      ),
      section(`Seed ${run.seed} over time`, timelineNote(experiment), panel, this.details),
      section('Verdicts', targetsTable(this.timeline.tracks, frames)),
      ...(pictures.length ? [section('Key frames', ...this.pictures(pictures))] : []),
      section('What was compared', methodList(experiment)),
      section('Limits', limitList(experiment)),
    );
    document.title = experiment.title;
    this.show();
    onFrameKeys(
      () => this.frame,
      (frame) => this.seek(frame),
    );
  }

  private seek(frame: number): void {
    this.frame = Math.max(0, Math.min(frame, this.experiment.run.time_s.length - 1));
    this.show();
  }

  private chooseLane(lane: string): void {
    this.lane = lane;
    this.show();
  }

  private chooseMethod(method: string): void {
    this.method = method;
    this.show();
  }

  private show(): void {
    this.timeline.setCurrent(this.frame);
    this.timeline.setChosen(this.lane, this.method);
    for (const button of document.querySelectorAll<HTMLElement>('[data-method]'))
      if (button instanceof HTMLButtonElement)
        button.setAttribute('aria-pressed', String(button.dataset['method'] === this.method));
    this.details.replaceChildren(
      card(this.timeline.titleOf(this.frame), this.truthFacts()),
      card(`${laneTitle(this.lane)}: where methods believe it`, this.errorTable()),
    );
  }

  private truthFacts(): HTMLElement {
    const { run, goal } = this.experiment;
    const hidden = run.hidden[this.frame] ?? null;
    const before = run.before_robot[this.frame] ?? false;
    const lane = run.lanes[this.lane];
    const verdict = lane?.verdicts[this.frame] ?? null;
    const source = lane?.sources[this.frame] ?? null;
    const facts = [
      { key: 'hidden', name: 'hidden by the robot', text: percent(hidden), value: hidden },
      { key: 'before', name: 'before the robot', text: before ? 'yes' : 'no', value: before },
      { key: 'source', name: 'our pose is', text: source ?? '', value: source },
    ];
    const shown = verdictOf(verdict ?? 'unknown');
    const words = verdict ? verdictNames[shown] : 'not detected';
    const heading = element('h3', `verdict ${shown}`, verdictIcon(shown), words);
    heading.dataset['value'] = JSON.stringify(verdict);
    const body = element('div', '', heading, factList(facts));
    if (this.frame === run.goal) body.append(element('p', 'hint', `This is the ${goal}.`));
    return body;
  }

  private errorTable(): HTMLElement {
    const { run, methods } = this.experiment;
    const errors = run.lanes[this.lane]?.errors ?? {};
    const turns = methods.some(({ key }) => errors[key]?.rotation_deg);
    const titles = ['method', 'off by', ...(turns ? ['turned by'] : [])];
    const head = element('tr', '', ...titles.map((title) => element('th', '', title)));
    const table = element('table', 'frame-errors', head);
    for (const { key, name } of methods) {
      const millimetres = errors[key]?.translation_mm[this.frame] ?? null;
      const degrees = errors[key]?.rotation_deg?.[this.frame] ?? null;
      const row = element('tr', key === this.method ? 'chosen' : '');
      const position = element('td', millimetres === null ? 'none' : '', errorText(millimetres));
      position.dataset['value'] = JSON.stringify(millimetres);
      row.append(element('th', '', lineSwatch(key), name), position);
      if (turns) row.append(element('td', '', degrees === null ? '' : `${degrees.toFixed(2)}°`));
      table.append(row);
    }
    return element('div', 'scroll', table);
  }

  /** What is drawn into them is the first and the last method, of the first kind of detection. */
  private pictures(pictures: readonly KeyFrame[]): HTMLElement[] {
    const { run, methods } = this.experiment;
    const [lane] = Object.values(run.lanes);
    const errorAt = (method: number, frame: number): string =>
      errorText(lane?.errors[methods.at(method)?.key ?? '']?.translation_mm[frame]);
    const captionOf = ({ index, title = '' }: KeyFrame): HTMLElement[] => [
      element('b', '', title),
      element('span', '', `frame ${index}, ${seconds(run.time_s[index])}`),
      element(
        'span',
        'legend-entry',
        verdictIcon(verdictOf(lane?.verdicts[index] ?? 'unknown')),
        `${percent(run.hidden[index], 0)} hidden`,
      ),
      element('span', '', `raw ${errorAt(0, index)}, handled ${errorAt(-1, index)}`),
    ];
    const note =
      'Red, dashed: the raw estimate. Green: handled by Penumbra. With the verdict of the image.';
    const gallery = keyFrames(pictures, captionOf, (frame) => this.seek(frame));
    gallery.classList.add('large');
    return [element('p', 'hint', note), gallery];
  }
}

function headOf(
  { penumbra, experiment, seeds }: Metrics,
  { title, story }: Experiment,
): HTMLElement {
  const command = `penumbra experiment ${experiment} --seeds ${seeds.join(':')}`;
  return element(
    'header',
    '',
    element('h1', '', title),
    element('p', 'story', story),
    element('p', 'hint', `Penumbra ${penumbra} · ${command}`),
  );
}

function tilesOf({ settings, seeds }: Metrics, { run }: Experiment): HTMLElement {
  const [least, most] = settings.latency_s.map((late) => (1e3 * late).toFixed(0));
  const last = run.time_s.at(-1) ?? 0;
  const every = settings.perception_every_frames;
  const rate = `${(1 / (run.frame_s * every)).toFixed(0)} a second`;
  return element(
    'div',
    'tiles',
    tile('seeds', String(seeds[1] - seeds[0]), `from ${seeds[0]}`),
    tile('each run', seconds(last, 1), `${(1 / run.frame_s).toFixed(0)} frames/s`),
    tile('perception works on', every === 1 ? 'every frame' : `1 in ${every} frames`, rate),
    tile('it answers after', `${least} to ${most} ms`, 'evenly distributed'),
    tile(
      'joints are off by',
      `${(1e3 * settings.joint_sigma_rad).toFixed(1)} mrad`,
      `and ${(1e3 * settings.joint_latency_s).toFixed(0)} ms late`,
    ),
  );
}

const timelineNote = ({ occluded_share }: Experiment): HTMLElement =>
  element(
    'p',
    'hint',
    'Of each kind of detection: the share that the robot truly hides, our verdict of the last ' +
      'image that perception worked on, and the error of every method. Shaded: more than ' +
      `${percent(occluded_share, 0)} hidden. A gap: no pose.`,
  );

function methodList({ methods }: Experiment): HTMLElement {
  const list = element('dl', 'methods');
  for (const { key, name, idea } of methods)
    list.append(element('dt', '', lineSwatch(key), name), element('dd', '', idea));
  return list;
}

const limitList = ({ limits }: Experiment): HTMLElement =>
  element('ul', 'limits', ...limits.split('\n').map((limit) => element('li', '', limit)));
