// The picture of a run, whichever way it is drawn: in space, or flat where there is no WebGL.

import type { Link } from "../data/freshness";
import type { HandView, Pixel } from "../hand/hand_view";
import type { Event, Frame, Hand, Scene, Vec3 } from "../messages";

export interface Picture {
  readonly view: HandView;
  readonly scene: Scene | null; // that is drawn
  readonly target_m: Vec3 | null; // where a headset's hand pulls to
  readonly is_hand_tracked: boolean; // by a headset
  readonly is_worn: boolean; // in a headset: nothing is seen on the screen
  readonly has_cameras: boolean; // it can be looked at from elsewhere
  // `is_current`: no other scene has come meanwhile.
  load(scene: Scene, is_current: () => boolean): Promise<void>;
  note(frame: Frame): void; // each frame, also those that are not drawn
  happened(event: Event): void;
  forget_events(): void;
  // `target`: where the handle is pulled to, null = it is not; `axis`: along which only.
  show(frame: Frame, target: Vec3 | null, axis: Vec3 | null): void;
  release(): void; // of a headset's hand
  on_screen(p_B: Vec3): Pixel;
  run(prepare: (now_ms: number) => void): void; // before every repaint
  draw(): void; // what is prepared, at once
}

// What a picture needs of the page.
export interface PictureInput {
  live_frame(): Frame | null; // what a hand acts upon
  send(hand: Hand): void;
  stop(): void; // the emergency stop, from within a headset
  link(): Link;
  page(): number; // of this connection
  report(key: string, problem: string): void;
}
