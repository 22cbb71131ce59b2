// Colours of the drawn scene; those of the page around it are in style.css.

export interface Theme {
  background: number;
  floor: number;
  grid: number;
  grid_strong: number;
  box: number;
  link: number; // links that come without a shape
  sky_light: number;
  ground_light: number;
  ambient: number;
  sun: number;
}

export const FORCE_COLOR = 0xf0643c;
export const TARGET_COLOR = 0x2f7bf6;

const LIGHT: Theme = {
  background: 0xeef1f4,
  floor: 0xe4e8ec,
  grid: 0xc6ced6,
  grid_strong: 0xaab5c0,
  box: 0x7b8a99,
  link: 0x8795a3,
  sky_light: 0xffffff,
  ground_light: 0xb9bfc6,
  ambient: 1.7,
  sun: 2.2,
};

const DARK: Theme = {
  background: 0x14191f,
  floor: 0x3d444c,
  grid: 0x2b333c,
  grid_strong: 0x4a5661,
  box: 0x66788a,
  link: 0x8795a3,
  sky_light: 0xe3e8ee,
  ground_light: 0x4a525b,
  ambient: 1.5,
  sun: 2.0,
};

const query = matchMedia("(prefers-color-scheme: dark)");

export function current_theme(): Theme {
  return query.matches ? DARK : LIGHT;
}

export function on_theme_change(listener: () => void): void {
  query.addEventListener("change", listener);
}
