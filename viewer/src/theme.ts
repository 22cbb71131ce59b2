// Light or dark: as the system says, until the user chooses. Colours of the drawn scene; those of
// the page around it are in style.css.

export interface Theme {
  is_dark: boolean;
  background: number;
  floor: number;
  grid: number;
  box: number;
  link: number; // links that come without a shape
  person: number;
  wall: number;
  sky_light: number;
  ground_light: number;
  ambient: number;
  sun: number;
  reflections: number;
  exposure: number;
}

// The device and the twin in all pictures and plots; the force has neither colour.
export const DEVICE_COLOR = 0x3f74b0;
export const TWIN_COLOR = 0xf0901e;
export const FORCE_COLOR = 0xd92642;
export const TORQUE_COLOR = 0xa855d8;
export const TARGET_COLOR = 0x2f7bf6;
export const ELBOW_COLOR = 0x0f9d8c;
export const REMOTE_COLOR = 0x5f9e14;
export const BASE_COLOR = 0x8a5a2b;
export const GHOST_COLOR = 0xd6409f;
export const SURFACE_COLOR = 0x6f8fb8;
export const CONTACT_COLOR = 0xf2a51a;
export const GOOD_COLOR = 0x2fa36b;
export const NEAR_COLOR = 0xe8a317;
export const ACTIVE_COLOR = 0xe23d2d;

const LIGHT: Theme = {
  is_dark: false,
  background: 0xe3e8ed,
  floor: 0xcfd6dd,
  grid: 0x8fa0b0,
  box: 0x5d7fae,
  link: 0x8795a3,
  person: 0xb9c6d2,
  wall: 0xf4f1ea,
  sky_light: 0xffffff,
  ground_light: 0xb4bac2,
  ambient: 0.75,
  sun: 2.0,
  reflections: 0.45,
  exposure: 1.0,
};

const DARK: Theme = {
  is_dark: true,
  background: 0x11161c,
  floor: 0x2b323a,
  grid: 0x6d7f90,
  box: 0x6f9ad6,
  link: 0x8795a3,
  person: 0x76879a,
  wall: 0x5a6068,
  sky_light: 0xdfe7f0,
  ground_light: 0x3a424b,
  ambient: 0.65,
  sun: 1.4,
  reflections: 0.4,
  exposure: 1.0,
};

type ThemeChoice = "system" | "light" | "dark";

const STORED_AS = "hapticgiant.theme";
const system = matchMedia("(prefers-color-scheme: dark)");
const listeners: (() => void)[] = [];
let choice: ThemeChoice = "system";

export function current_theme(): Theme {
  const is_dark = choice === "system" ? system.matches : choice === "dark";
  return is_dark ? DARK : LIGHT;
}

export function on_theme_change(listener: () => void): void {
  listeners.push(listener);
}

export function choose_theme(wanted: ThemeChoice): void {
  choice = wanted;
  localStorage.setItem(STORED_AS, wanted);
  apply();
}

export function start_theme(): void {
  const stored = localStorage.getItem(STORED_AS);
  if (stored === "light" || stored === "dark") choice = stored;
  system.addEventListener("change", apply);
  apply();
}

function apply(): void {
  document.documentElement.dataset.theme = current_theme().is_dark ? "dark" : "light";
  for (const listener of listeners) listener();
}
