// Plays the motion: there, a moment of rest, again.
import {h} from "./dom";

const kTravel = 1.6; // seconds
const kRest = 0.7;

export class Player {
  readonly element: HTMLElement;
  private readonly button = h("button", {title: "Carry the model through the isometry (space)", click: () => this.toggle()}, "▶");
  private readonly slider: HTMLInputElement;
  private playing = false;
  private start = 0;

  constructor(private readonly setTime: (t: number) => void) {
    this.slider = h("input", {
      type: "range", min: "0", max: "1", step: "0.01", value: "0", "aria-label": "Motion",
      input: () => {
        this.stop();
        setTime(Number(this.slider.value));
      },
    });
    this.element = h("div", {class: "player"}, this.button, this.slider);
  }

  toggle(): void {
    this.playing ? this.stop() : this.play();
  }

  reset(): void {
    this.slider.value = "0";
    if (this.playing) this.start = performance.now();
  }

  private play(): void {
    this.playing = true;
    this.button.textContent = "❚❚";
    this.start = performance.now();
    const tick = () => {
      if (!this.playing) return;
      const t = ((performance.now() - this.start) / 1000) % (kTravel + kRest);
      const share = Math.min(1, t / kTravel);
      const eased = share * share * (3 - 2 * share);
      this.slider.value = String(eased);
      this.setTime(eased);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  stop(): void {
    this.playing = false;
    this.button.textContent = "▶";
  }
}
