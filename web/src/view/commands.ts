// SPDX-License-Identifier: Apache-2.0
// What can be done with the page: by key, by button (data-key names the key), and as the help tells.
import { nextOnset } from '../model/timeline';
import { speeds } from '../model/player';
import type { ScenePart } from '../scene/scene_view';
import type { Viewer } from '../viewer';
import { byId, element, setText, svg } from './dom';
import { layersOf, type Layer } from './image_view';
import { fillDialog } from './page';

export interface Player {
  toggle(): void;
  seek(frame: number): void;
  current(): number;
  speed(factor: number): void;
}

interface Command {
  /** As the help shows the keys. */
  readonly shown: string;
  readonly help: string;
  readonly actions: Readonly<Record<string, (isFar: boolean) => void>>;
}

const layerNames: Readonly<Record<Layer, readonly [string, string]>> = {
  overlay: ['Overlay', 'labels and targets over the colour image'],
  labels: ['Labels', 'what stands before the robot, or is hidden by it'],
  links: ['Links', 'which link is on the ray'],
  vdi: ['Virtual', 'virtual depth: what the camera would measure of the robot alone'],
  depth: ['Measured', 'measured depth'],
};

/** The same key means the same layer, whichever there are. */
const layerOrder = Object.keys(layerNames) as Layer[];

const farStep = 10; // frames

export function bindCommands(viewer: Viewer, player: Player): void {
  const isLive = viewer.session.mode === 'live';
  const commands = [
    ...(isLive ? liveCommands(player) : storedCommands(viewer, player)),
    ...viewCommands(viewer, bindLayers(viewer)),
  ];
  const actions = Object.assign({}, ...commands.map((one) => one.actions)) as Command['actions'];
  const help = fillHelp(commands);
  const all: Command['actions'] = { ...actions, '?': () => help.showModal() };
  for (const button of document.querySelectorAll<HTMLButtonElement>('[data-key]')) {
    const key = button.dataset['key'] ?? '';
    button.addEventListener('click', () => all[key]?.(false));
  }
  for (const [id, paths] of Object.entries(icons)) byId(id).append(iconOf(paths));
  bindKeys(all);
  bindSceneParts(viewer);
}

const liveCommands = (player: Player): Command[] => [
  { shown: 'space', help: 'hold the picture, or go on', actions: { ' ': () => player.toggle() } },
];

function storedCommands(viewer: Viewer, player: Player): Command[] {
  const step = (by: number) => (isFar: boolean) =>
    player.seek(player.current() + (isFar ? farStep * by : by));
  const speed = bindSpeed(player);
  return [
    { shown: 'space', help: 'play or pause', actions: { ' ': () => player.toggle() } },
    {
      shown: '← →',
      help: `one frame back or on; with shift ${farStep}`,
      actions: { ArrowLeft: step(-1), ArrowRight: step(1) },
    },
    {
      shown: 'Home End',
      help: 'first or last frame',
      actions: { Home: () => player.seek(0), End: () => player.seek(Infinity) },
    },
    {
      shown: '[ ]',
      help: 'previous or next occlusion',
      actions: { '[': () => jump(viewer, player, -1), ']': () => jump(viewer, player, 1) },
    },
    {
      shown: '− +',
      help: 'slower or faster',
      actions: { '-': () => speed(-1), '+': () => speed(1), '=': () => speed(1) },
    },
  ];
}

function viewCommands(viewer: Viewer, showLayer: (layer: Layer) => void): Command[] {
  const layers = layersOf(viewer.session.parts);
  const keyOf = (layer: Layer): string => String(layerOrder.indexOf(layer) + 1);
  return [
    {
      shown: '↑ ↓',
      help: 'previous or next target',
      actions: { ArrowUp: () => chooseNext(viewer, -1), ArrowDown: () => chooseNext(viewer, 1) },
    },
    {
      shown: layers.map(keyOf).join(' '),
      help: layers.map((layer) => layerNames[layer][0].toLowerCase()).join(', '),
      actions: Object.fromEntries(layers.map((layer) => [keyOf(layer), () => showLayer(layer)])),
    },
    {
      shown: 'L',
      help: 'points by label or by colour',
      actions: { l: () => viewer.setCloudByLabel(togglePressed('l')) },
    },
    {
      shown: 'W',
      help: 'points and images with or without the robot',
      actions: { w: () => toggleWithoutRobot(viewer) },
    },
    {
      shown: 'V C',
      help: 'overview, or the view from the camera',
      actions: { v: () => viewer.scene?.frameAll(), c: () => viewer.scene?.frameCamera() },
    },
    { shown: 'T', help: 'light or dark', actions: { t: () => byId('theme').click() } },
  ];
}

function bindKeys(actions: Command['actions']): void {
  // A button that was clicked would take the space key that plays; one reached by tab keeps it.
  document.addEventListener('click', ({ target }) => {
    const pressed = target instanceof Element ? target.closest<HTMLElement>('button, input') : null;
    if (pressed && !pressed.matches(':focus-visible')) pressed.blur();
  });
  document.addEventListener('keydown', (event) => {
    const { key, target, shiftKey } = event;
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector('dialog[open]'))
      return;
    const on = target instanceof Element ? target : document.body;
    if (on.closest('select')) return;
    if (on.closest('input') && key.startsWith('Arrow')) return; // goes to the next radio button
    if (on.closest('button, input') && key === ' ') return; // presses it
    const action = actions[key.length === 1 ? key.toLowerCase() : key];
    if (!action) return;
    event.preventDefault();
    action(shiftKey);
  });
}

function fillHelp(commands: readonly Command[]): HTMLDialogElement {
  const list = element('dl', 'keys');
  for (const { shown, help } of [...commands, { shown: '?', help: 'this help' }]) {
    const names = shown.split(' ').map((name) => element('kbd', '', name));
    list.append(element('dt', '', ...names), element('dd', '', help));
  }
  const pointer =
    'Scene: drag to turn, wheel or pinch to come nearer, right button or two fingers to move. ' +
    'Timeline: click or drag. Panes: drag their borders; a double click resets one. Colours are ' +
    'Okabe and Ito’s, told apart with all common forms of colour blindness; verdicts have shapes ' +
    'and patterns as well.';
  return fillDialog('help', 'Keys', list, element('p', 'hint', pointer));
}

function jump(viewer: Viewer, player: Player, direction: 1 | -1): void {
  const { tracks } = viewer.timeline;
  const frame = nextOnset(tracks, player.current(), direction);
  if (frame === undefined) {
    setText(byId('announce'), `no ${direction === 1 ? 'later' : 'earlier'} occlusion begins`);
    return;
  }
  const names = tracks
    .filter((track) => nextOnset([track], frame - 1, 1) === frame)
    .map((track) => track.name);
  if (names[0] !== undefined && !names.includes(viewer.chosen ?? '')) viewer.choose(names[0]);
  setText(byId('announce'), `${names.join(', ')}: occlusion begins`);
  player.seek(frame);
}

function chooseNext(viewer: Viewer, by: number): void {
  const names = viewer.timeline.tracks.map((track) => track.name);
  const at = names.indexOf(viewer.chosen ?? '');
  const name = names[Math.max(0, Math.min(names.length - 1, at + by))];
  if (name !== undefined) viewer.choose(name);
}

/** @returns makes it faster or slower by a step */
function bindSpeed(player: Player): (by: number) => void {
  const select = byId<HTMLSelectElement>('speed');
  select.append(...speeds.map((speed) => new Option(`${speed}×`, String(speed))));
  const choose = (index: number): void => {
    select.selectedIndex = Math.max(0, Math.min(speeds.length - 1, index));
    player.speed(Number(select.value));
  };
  choose(speeds.indexOf(1));
  select.addEventListener('change', () => {
    choose(select.selectedIndex);
    select.blur();
  });
  return (by) => choose(select.selectedIndex + by);
}

/** @returns shows a layer */
function bindLayers(viewer: Viewer): (layer: Layer) => void {
  const layers = layersOf(viewer.session.parts);
  const inputs = layers.map((layer) => {
    const [name, meaning] = layerNames[layer];
    const input = element('input');
    Object.assign(input, { type: 'radio', name: 'layer', value: layer });
    const label = element('label', '', input, name);
    label.title = `${meaning} (${layerOrder.indexOf(layer) + 1})`;
    input.addEventListener('change', () => viewer.setLayer(layer));
    byId('layers').append(label);
    return input;
  });
  const show = (layer: Layer): void => {
    const input = inputs[layers.indexOf(layer)];
    if (input) input.checked = true;
    viewer.setLayer(layer);
  };
  if (layers[0]) show(layers[0]);
  return show;
}

function bindSceneParts(viewer: Viewer): void {
  for (const button of document.querySelectorAll<HTMLButtonElement>('[data-part]'))
    button.addEventListener('click', () => {
      const shown = button.getAttribute('aria-pressed') !== 'true';
      button.setAttribute('aria-pressed', String(shown));
      viewer.setShown(button.dataset['part'] as ScenePart, shown);
    });
  // On a phone one of scene and image is shown.
  for (const tab of document.querySelectorAll<HTMLInputElement>('#view-tabs input'))
    tab.addEventListener('change', () => {
      byId('main').dataset['view'] = tab.value;
      viewer.scene?.invalidate();
    });
}

/** @returns whether the buttons of a key are pressed now */
function togglePressed(key: string): boolean {
  const buttons = document.querySelectorAll(`[data-key=${key}]`);
  const pressed = buttons[0]?.getAttribute('aria-pressed') !== 'true';
  for (const button of buttons) button.setAttribute('aria-pressed', String(pressed));
  return pressed;
}

/** The model of the robot goes and comes, too; its own button shows it again. */
function toggleWithoutRobot(viewer: Viewer): void {
  const on = togglePressed('w');
  const model = document.querySelector<HTMLButtonElement>('[data-part=robot]');
  if (model?.getAttribute('aria-pressed') === String(on)) model.click();
  viewer.setWithoutRobot(on);
}

/** Of the player's buttons. Play and pause are both there; the style sheet shows one. */
const icons: Readonly<Record<string, readonly (readonly [string, string])[]>> = {
  first: [['M5 5v14M19 5 9 12l10 7z', '']],
  'step-back': [['M15.5 6 8 12l7.5 6z', '']],
  play: [
    ['M7 4.5v15l12-7.5z', 'when-paused'],
    ['M7 5h3.5v14H7zM13.5 5H17v14h-3.5z', 'when-playing'],
  ],
  'step-forward': [['M8.5 6 16 12l-7.5 6z', '']],
  last: [['M19 5v14M5 5l10 7-10 7z', '']],
};

const iconOf = (paths: readonly (readonly [string, string])[]): SVGSVGElement =>
  svg(
    'svg',
    { viewBox: '0 0 24 24', 'aria-hidden': 'true', class: 'player-icon' },
    ...paths.map(([d, name]) => svg('path', { d, class: name })),
  );
