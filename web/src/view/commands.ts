// SPDX-License-Identifier: Apache-2.0
// The page's commands, by key and by the elements whose data-key names the key.
import type { Layer } from '../api/types';
import { nextOnset } from '../model/timeline';
import type { ScenePart } from '../scene/scene_view';
import type { FrameSource, Viewer } from '../viewer';
import { byId, setText, svg } from './dom';
import { partsOf } from './image_view';

/** The value is true with the shift key. */
type Commands = Readonly<Record<string, (isShift: boolean) => void>>;

const layers: readonly Layer[] = ['overlay', 'labels', 'links', 'vdi', 'depth', 'residual']; // keys 1 to 6
const shiftStep = 10; // frames
const speeds = [0.25, 0.5, 1, 2, 4];

export function bindCommands(viewer: Viewer, source: FrameSource): void {
  const isLive = viewer.session.mode === 'live';
  const commands: Commands = {
    ' ': () => source.togglePlaying(),
    ...(isLive ? {} : storedCommands(viewer, source)),
    ...layerCommands(viewer),
    ArrowUp: () => selectNext(viewer, -1),
    ArrowDown: () => selectNext(viewer, 1),
    l: () => viewer.setCloudByLabel(togglePressed('l')),
    w: () => toggleWithoutRobot(viewer),
    v: () => viewer.scene?.showOverview(),
    c: () => viewer.scene?.showCameraView(),
    t: () => byId('theme').click(),
    '?': () => byId<HTMLDialogElement>('help').showModal(),
  };
  for (const node of document.querySelectorAll<HTMLElement>('[data-key]'))
    node.addEventListener('click', () => commands[node.dataset['key'] ?? '']?.(false));
  for (const [id, paths] of Object.entries(icons)) byId(id).append(iconOf(paths));
  bindKeys(commands);
  bindSceneParts(viewer);
}

function storedCommands(viewer: Viewer, source: FrameSource): Commands {
  const step = (by: number) => (isShift: boolean) =>
    source.seek(source.current + (isShift ? shiftStep * by : by));
  const changeSpeed = bindSpeed(source);
  return {
    ArrowLeft: step(-1),
    ArrowRight: step(1),
    Home: () => source.seek(0),
    End: () => source.seek(Infinity),
    '[': () => jump(viewer, source, -1),
    ']': () => jump(viewer, source, 1),
    '-': () => changeSpeed(-1),
    '+': () => changeSpeed(1),
    '=': () => changeSpeed(1),
  };
}

/** Removes layers without data from the page, and shows the first one. */
function layerCommands(viewer: Viewer): Commands {
  const { parts } = viewer.session;
  const isAvailable = (layer: Layer): boolean =>
    partsOf(layer).every((part) => parts.includes(part)) ||
    (layer === 'overlay' && parts.includes('labels'));
  const commands: Record<string, () => void> = {};
  layers.forEach((layer, index) => {
    const key = String(index + 1);
    const input = document.querySelector<HTMLInputElement>(`#layers [data-key="${key}"]`);
    if (!isAvailable(layer)) return input?.closest('label')?.remove();
    commands[key] = () => {
      if (input) input.checked = true;
      viewer.setLayer(layer);
    };
  });
  Object.values(commands)[0]?.();
  return commands;
}

function bindKeys(commands: Commands): void {
  // After a click the space key plays; after a tab it presses the focused button.
  document.addEventListener('click', ({ target }) => {
    const pressed = target instanceof Element ? target.closest<HTMLElement>('button, input') : null;
    if (pressed && !pressed.matches(':focus-visible')) pressed.blur();
  });
  document.addEventListener('keydown', (event) => {
    const { key, target, shiftKey } = event;
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector('dialog[open]'))
      return;
    const focused = target instanceof Element ? target : document.body;
    if (focused.closest('select')) return;
    if (focused.closest('input') && key.startsWith('Arrow')) return; // next radio button
    if (focused.closest('button, input') && key === ' ') return; // presses it
    const command = commands[key.length === 1 ? key.toLowerCase() : key];
    if (!command) return;
    event.preventDefault();
    command(shiftKey);
  });
}

function jump(viewer: Viewer, source: FrameSource, direction: 1 | -1): void {
  const { tracks } = viewer.timeline;
  const frame = nextOnset(tracks, source.current, direction);
  if (frame === undefined)
    return setText(byId('announce'), `no ${direction === 1 ? 'later' : 'earlier'} occlusion`);
  const names = tracks
    .filter((track) => nextOnset([track], frame - 1, 1) === frame)
    .map((track) => track.name);
  if (names[0] !== undefined && !names.includes(viewer.selected ?? '')) viewer.select(names[0]);
  setText(byId('announce'), `occlusion starts: ${names.join(', ')}`);
  source.seek(frame);
}

function selectNext(viewer: Viewer, by: number): void {
  const names = viewer.timeline.tracks.map((track) => track.name);
  const at = names.indexOf(viewer.selected ?? '') + by;
  const name = names[Math.max(0, Math.min(names.length - 1, at))];
  if (name !== undefined) viewer.select(name);
}

/** @returns a function that changes the speed by a number of steps */
function bindSpeed(source: FrameSource): (by: number) => void {
  const select = byId<HTMLSelectElement>('speed');
  select.append(...speeds.map((speed) => new Option(`${speed}×`, String(speed))));
  const choose = (index: number): void => {
    select.selectedIndex = Math.max(0, Math.min(speeds.length - 1, index));
    source.setSpeed(Number(select.value));
  };
  choose(speeds.indexOf(1));
  select.addEventListener('change', () => {
    choose(select.selectedIndex);
    select.blur();
  });
  return (by) => choose(select.selectedIndex + by);
}

function bindSceneParts(viewer: Viewer): void {
  if (!viewer.session.parts.includes('cloud'))
    for (const button of document.querySelectorAll('[data-part=cloud], [data-key=l], [data-key=w]'))
      button.remove();
  for (const button of document.querySelectorAll<HTMLElement>('[data-part]'))
    button.addEventListener('click', () => {
      const shown = button.getAttribute('aria-pressed') !== 'true';
      button.setAttribute('aria-pressed', String(shown));
      viewer.setShown(button.dataset['part'] as ScenePart, shown);
    });
  // A phone shows either scene or image.
  for (const tab of document.querySelectorAll<HTMLInputElement>('#view-tabs input'))
    tab.addEventListener('change', () => {
      byId('main').dataset['view'] = tab.value;
      viewer.scene?.invalidate();
    });
}

/** Toggles the buttons of a key; returns whether they are pressed now. */
function togglePressed(key: string): boolean {
  const buttons = document.querySelectorAll(`[data-key=${key}]`);
  const isPressed = buttons[0]?.getAttribute('aria-pressed') !== 'true';
  for (const button of buttons) button.setAttribute('aria-pressed', String(isPressed));
  return isPressed;
}

/** Also hides or shows the robot model, whose button shows it again. */
function toggleWithoutRobot(viewer: Viewer): void {
  const on = togglePressed('w');
  const model = document.querySelector<HTMLElement>('[data-part=robot]');
  if (model?.getAttribute('aria-pressed') === String(on)) model.click();
  viewer.setWithoutRobot(on);
}

/** Icons of the player's buttons: path and class. The style sheet shows either play or pause. */
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
