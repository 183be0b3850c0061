// SPDX-License-Identifier: Apache-2.0
import type { Viewer } from '../viewer';
import { layerKeys, toggleCloudColors, toggleWithoutRobot, type Actions } from './controls';
import { byId, element } from './dom';
import { layersOf, type Layer } from './image_view';

interface Bindings {
  readonly viewer: Viewer;
  readonly actions: Actions;
  step(by: number): () => void;
  jump(direction: 1 | -1): () => void;
  speed(by: number): void;
  showLayer(layer: Layer): void;
}

type Help = readonly (readonly [string, string])[];

const layerWords: Readonly<Record<Layer, string>> = {
  overlay: 'overlay',
  labels: 'labels',
  links: 'links',
  vdi: 'virtual depth',
  depth: 'measured depth',
};

/** Live no frame but the newest can be shown. */
const storedHelp: Help = [
  ['← →', 'one frame back or on; with shift ten'],
  ['Home End', 'first or last frame'],
  ['[ ]', 'previous or next occlusion'],
  ['− +', 'slower or faster'],
];

function helpOf({ session }: Viewer): Help {
  const isLive = session.mode === 'live';
  const layers = layersOf(session.parts);
  const keys = Object.entries(layerKeys).filter(([, layer]) => layers.includes(layer));
  return [
    ['space', isLive ? 'hold the picture, or go on' : 'play or pause'],
    ...(isLive ? [] : storedHelp),
    ['↑ ↓', 'previous or next target'],
    [keys.map(([key]) => key).join(' '), keys.map(([, layer]) => layerWords[layer]).join(', ')],
    ['L', 'points by label or by colour'],
    ['W', 'points and images with or without the robot'],
    ['V C', 'overview, or the view from the camera'],
    ['T', 'light or dark'],
    ['?', 'this help'],
  ];
}

export function bindKeys(bindings: Bindings): void {
  const dialog = fillHelp(bindings.viewer);
  byId('help-button').addEventListener('click', () => dialog.showModal());
  // A button that was clicked would take the space key that plays; one reached by tab keeps it.
  document.addEventListener('click', ({ detail, target }) => {
    if (detail > 0 && target instanceof Element)
      target.closest<HTMLElement>('#main button')?.blur();
  });
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector('dialog[open]'))
      return;
    const on = event.target instanceof HTMLElement ? event.target : document.body;
    if (on.closest('select, input')) return;
    const pressesButton = event.key === ' ' && on.closest('button') !== null;
    const action = pressesButton ? undefined : actionOf(event, bindings, dialog);
    if (!action) return;
    event.preventDefault();
    action();
  });
}

function actionOf(
  event: KeyboardEvent,
  { viewer, actions, step, jump, speed, showLayer }: Bindings,
  dialog: HTMLDialogElement,
): (() => void) | undefined {
  const layer = layerKeys[event.key];
  if (layer) return () => showLayer(layer);
  const far = event.shiftKey ? 10 : 1;
  const ofStored: Readonly<Record<string, () => void>> = {
    ArrowLeft: step(-far),
    ArrowRight: step(far),
    Home: () => actions.seek(0),
    End: () => actions.seek(Infinity),
    '[': jump(-1),
    ']': jump(1),
    '-': () => speed(-1),
    '+': () => speed(1),
    '=': () => speed(1),
  };
  const actionOfKey: Readonly<Record<string, () => void>> = {
    ...(viewer.session.mode === 'live' ? {} : ofStored),
    ' ': () => actions.toggle(),
    ArrowUp: () => chooseNext(viewer, -1),
    ArrowDown: () => chooseNext(viewer, 1),
    l: () => toggleCloudColors(viewer),
    w: () => toggleWithoutRobot(viewer),
    v: () => viewer.scene?.frameAll(),
    c: () => viewer.scene?.frameCamera(),
    t: () => byId('theme').click(),
    '?': () => dialog.showModal(),
  };
  return actionOfKey[event.key.length === 1 ? event.key.toLowerCase() : event.key];
}

function chooseNext(viewer: Viewer, by: number): void {
  const names = viewer.timeline.tracks.map((track) => track.name);
  const at = names.indexOf(viewer.chosen ?? '');
  const name = names[Math.max(0, Math.min(names.length - 1, at + by))];
  if (name !== undefined) viewer.choose(name);
}

function fillHelp(viewer: Viewer): HTMLDialogElement {
  const dialog = byId<HTMLDialogElement>('help');
  const heading = element('h2', '', 'Keys');
  heading.id = 'help-title';
  const list = element('dl', 'keys');
  for (const [keys, meaning] of helpOf(viewer)) {
    const names = keys.split(' ').map((key) => (key === '…' ? key : element('kbd', '', key)));
    list.append(element('dt', '', ...names), element('dd', '', meaning));
  }
  const close = element('button', 'primary', 'Close');
  close.addEventListener('click', () => dialog.close());
  const pointer = element(
    'p',
    'hint',
    'Scene: drag to turn, wheel or pinch to come nearer, right button or two fingers to move. Timeline: click or drag. Colours are Okabe and Ito’s, told apart with all common forms of colour blindness; verdicts have shapes and patterns as well.',
  );
  dialog.replaceChildren(heading, list, pointer, close);
  dialog.addEventListener('click', (event) => event.target === dialog && dialog.close());
  return dialog;
}
