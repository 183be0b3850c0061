// SPDX-License-Identifier: Apache-2.0

const keyStep = 5; // percent

/** The divider between colour image (left) and layer (right): dragged, or moved by arrow keys. */
export class CompareSlider {
  private percent = 50;

  constructor(
    private readonly handle: HTMLElement,
    private readonly frame: HTMLElement,
    private readonly top: HTMLElement,
  ) {
    handle.addEventListener('pointerdown', (event) => {
      event.preventDefault();
      handle.focus();
      handle.setPointerCapture(event.pointerId);
    });
    handle.addEventListener('pointermove', (event) => {
      if (!handle.hasPointerCapture(event.pointerId)) return;
      const box = frame.getBoundingClientRect();
      this.set((100 * (event.clientX - box.left)) / box.width);
    });
    handle.addEventListener('keydown', (event) => this.key(event));
    this.set(0);
  }

  set(percent: number): void {
    this.percent = Math.min(100, Math.max(0, percent));
    this.frame.style.setProperty('--split', this.percent.toFixed(2));
    this.top.style.clipPath = `inset(0 0 0 ${this.percent.toFixed(2)}%)`;
    this.handle.setAttribute('aria-valuenow', this.percent.toFixed(0));
    this.handle.setAttribute('aria-valuetext', `${this.percent.toFixed(0)} % colour image`);
  }

  private key(event: KeyboardEvent): void {
    const to: Readonly<Record<string, number>> = {
      ArrowLeft: this.percent - keyStep,
      ArrowRight: this.percent + keyStep,
      Home: 0,
      End: 100,
    };
    const percent = to[event.key];
    if (percent === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    this.set(percent);
  }
}
