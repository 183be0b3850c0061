// SPDX-License-Identifier: Apache-2.0
// Buttons and keys of the page; what they do is the viewer's and the player's.
import { nextOnset } from '../model/occlusions';
import { speeds } from '../model/player';
import type { ScenePart } from '../scene/scene_view';
import type { Viewer } from '../viewer';
import { byId, element, setText } from './dom';
import { bindKeys } from './keys';
import { layersOf, type Layer } from './image_view';
import { playerIcon } from './player_icons';
import { bindRadioKeys, markChosen } from './radio_keys';

export interface Actions {
  toggle(): void;
  seek(frame: number): void;
  current(): number;
  speed(factor: number): void;
}

const layerNames: Readonly<Record<Layer, readonly [string, string]>> = {
  overlay: ['Overlay', 'labels and targets over the colour image'],
  labels: ['Labels', 'what stands before the robot, or is hidden by it'],
  links: ['Links', 'which link is on the ray'],
  vdi: ['Virtual', 'virtual depth: what the camera would measure of the robot alone'],
  depth: ['Measured', 'measured depth'],
};

/** The same key means the same layer, whichever there are. */
export const layerKeys: Readonly<Record<string, Layer>> = {
  1: 'overlay',
  2: 'labels',
  3: 'links',
  4: 'vdi',
  5: 'depth',
};

export function bindControls(viewer: Viewer, actions: Actions): void {
  const step = (by: number) => (): void => actions.seek(actions.current() + by);
  const jump = (direction: 1 | -1) => (): void => jumpToOcclusion(viewer, actions, direction);
  const buttons = {
    'previous-occlusion': jump(-1),
    'step-back': step(-1),
    play: () => actions.toggle(),
    'step-forward': step(1),
    'next-occlusion': jump(1),
  };
  for (const [id, action] of Object.entries(buttons)) {
    byId(id).append(playerIcon(id));
    byId(id).addEventListener('click', action);
  }
  const speed = bindSpeed(actions);
  const showLayer = bindLayers(viewer);
  bindScene(viewer);
  bindTabs(viewer);
  bindKeys({ viewer, actions, step, jump, speed, showLayer });
}

function jumpToOcclusion(viewer: Viewer, actions: Actions, direction: 1 | -1): void {
  const { tracks } = viewer.timeline;
  const frame = nextOnset(tracks, actions.current(), direction);
  const where = direction === 1 ? 'later' : 'earlier';
  if (frame === null) {
    setText(byId('announce'), `no ${where} occlusion begins`);
    return;
  }
  const names = tracks.filter((track) => nextOnset([track], frame - 1, 1) === frame);
  const first = names[0];
  if (first && !names.some((track) => track.name === viewer.chosen)) viewer.choose(first.name);
  setText(byId('announce'), `${names.map((track) => track.name).join(', ')}: occlusion begins`);
  actions.seek(frame);
}

function bindSpeed(actions: Actions): (by: number) => void {
  const select = byId<HTMLSelectElement>('speed');
  for (const value of speeds) {
    const option = element('option', '', `${value}×`);
    option.value = String(value);
    select.append(option);
  }
  select.value = '1';
  select.addEventListener('change', () => {
    actions.speed(Number(select.value));
    select.blur();
  });
  return (by) => {
    const index = Math.max(0, Math.min(speeds.length - 1, select.selectedIndex + by));
    select.selectedIndex = index;
    actions.speed(speeds[index] ?? 1);
  };
}

/** @returns shows a layer, where it can be had */
function bindLayers(viewer: Viewer): (layer: Layer) => void {
  const layers = layersOf(viewer.session.parts);
  const group = byId('layers');
  const show = (layer: Layer): void => {
    viewer.image.layer = layer;
    const button = group.querySelector(`[data-layer=${layer}]`);
    if (button) markChosen(group, 'aria-checked', button);
    viewer.handlers.wantsChanged();
    viewer.redraw();
  };
  for (const layer of layers) {
    const [name, meaning] = layerNames[layer];
    const button = element('button', '', name);
    button.type = 'button';
    const key = Object.keys(layerKeys).find((one) => layerKeys[one] === layer) ?? '';
    button.title = `${meaning} (${key})`;
    button.setAttribute('role', 'radio');
    button.dataset['layer'] = layer;
    button.addEventListener('click', () => show(layer));
    group.append(button);
  }
  bindRadioKeys(group);
  const first = layers[0];
  if (first) show(first);
  return (layer) => {
    if (layers.includes(layer)) show(layer);
  };
}

function bindScene(viewer: Viewer): void {
  for (const button of document.querySelectorAll<HTMLButtonElement>('#scene-tools [data-part]'))
    button.addEventListener('click', () => {
      const shown = button.getAttribute('aria-pressed') !== 'true';
      button.setAttribute('aria-pressed', String(shown));
      viewer.setShown(button.dataset['part'] as ScenePart, shown);
    });
  byId('cloud-colors').addEventListener('click', () => toggleCloudColors(viewer));
  for (const button of withoutRobotButtons())
    button.addEventListener('click', () => toggleWithoutRobot(viewer));
  byId('view-all').addEventListener('click', () => viewer.scene?.frameAll());
  byId('view-camera').addEventListener('click', () => viewer.scene?.frameCamera());
}

export function toggleCloudColors(viewer: Viewer): void {
  const button = byId('cloud-colors');
  const byLabel = button.getAttribute('aria-pressed') !== 'true';
  button.setAttribute('aria-pressed', String(byLabel));
  viewer.scene?.cloud.setColors(byLabel ? 'label' : 'color');
  viewer.scene?.invalidate();
}

/** One of them is visible: on a phone the scene and the image each have one. */
const withoutRobotButtons = (): NodeListOf<HTMLButtonElement> =>
  document.querySelectorAll('.without-robot');

/** The model of the robot goes and comes, too; its own button shows it again. */
export function toggleWithoutRobot(viewer: Viewer): void {
  const buttons = withoutRobotButtons();
  const on = buttons[0]?.getAttribute('aria-pressed') !== 'true';
  for (const button of buttons) button.setAttribute('aria-pressed', String(on));
  const model = document.querySelector<HTMLButtonElement>('#scene-tools [data-part=robot]');
  if (model?.getAttribute('aria-pressed') === String(on)) model.click();
  viewer.setWithoutRobot(on);
}

/** On a phone one of scene and image is shown. */
function bindTabs(viewer: Viewer): void {
  const main = byId('main');
  const tabs = byId('view-tabs');
  bindRadioKeys(tabs);
  for (const tab of tabs.querySelectorAll('button'))
    tab.addEventListener('click', () => {
      main.dataset['view'] = tab.dataset['view'];
      markChosen(tabs, 'aria-selected', tab);
      viewer.scene?.invalidate();
    });
}
