// Colours that people with any colour vision can tell apart: those of Okabe and Ito, then the same lighter or darker.
import {Color} from "three";

export interface Theme {
  background: number;
  model: number;
  edge: number;
  point: number;
  halves: [number, number];
  mover: number;
  element: number;
  ink: number;
}

export const kLight: Theme = {
  background: 0xf6f7f9, model: 0xd5d9e0, edge: 0x6b7480, point: 0x59636f,
  halves: [0xbcd7ee, 0xf2dcae], mover: 0x0072b2, element: 0xb0246e, ink: 0x15191e,
};

export const kDark: Theme = {
  background: 0x14171b, model: 0x6f7885, edge: 0xb4bcc6, point: 0xaeb6c0,
  halves: [0x56799a, 0x98804f], mover: 0x56b4e9, element: 0xff7fb6, ink: 0xf4f6f8,
};

const kOrbits = {
  light: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a5195"],
  dark: ["#56b4e9", "#e69f00", "#2fc39a", "#e79ac4", "#f0e442", "#ff8248", "#b79cf0"],
};

export function orbitColour(index: number, dark: boolean): Color {
  const colours = dark ? kOrbits.dark : kOrbits.light;
  const colour = new Color(colours[index % colours.length]);
  const round = Math.floor(index / colours.length) % 3;
  return round === 0 ? colour : colour.offsetHSL(0, 0, round === 1 ? 0.13 : -0.13);
}
