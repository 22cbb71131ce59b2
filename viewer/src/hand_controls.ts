// Keys, buttons and check box of the hand, and the ring that says where the handle is.

import type { Drag } from "./drag";
import type { Scene } from "./messages";
import { element } from "./panel";
import { hint_text } from "./text";

export function has_lever(scene: Scene): boolean {
  return scene.twin.joints.some((joint) => /lever|handle|latch/i.test(joint.name));
}

export function connect_hand_controls(drag: Drag, scene: Scene): void {
  const lever = has_lever(scene);
  const press = element<HTMLButtonElement>("press");
  const lift = element<HTMLButtonElement>("lift");
  const automatic = element<HTMLInputElement>("press-while-dragging");
  element("lever").hidden = !lever;
  element("hint").textContent = hint_text(lever, matchMedia("(pointer: coarse)").matches);

  automatic.checked = lever;
  drag.presses_while_dragging = lever;
  automatic.addEventListener("change", () => (drag.presses_while_dragging = automatic.checked));
  lift.addEventListener("click", () => (drag.is_lifting = !drag.is_lifting));

  press.addEventListener("pointerdown", (event) => {
    press.setPointerCapture(event.pointerId);
    drag.set_pressing(true);
  });
  press.addEventListener("lostpointercapture", () => drag.set_pressing(false));
  for (const [name, is_pressing] of [["keydown", true], ["keyup", false]] as const) {
    addEventListener(name, (event) => {
      if (event.code !== "Space" || event.target instanceof HTMLInputElement) return;
      event.preventDefault();
      drag.set_pressing(is_pressing);
    });
  }
}

export function show_hand(drag: Drag, handle_px: { x: number; y: number }): void {
  const grip = element("grip");
  grip.hidden = false;
  grip.style.transform = `translate(${handle_px.x.toFixed(1)}px, ${handle_px.y.toFixed(1)}px)`;
  grip.dataset.held = String(drag.is_dragging);
  if (drag.is_dragging) grip.dataset.known = "true"; // the label has done its work
  element("press").setAttribute("aria-pressed", String(drag.press > 0));
  element("lift").setAttribute("aria-pressed", String(drag.is_lifting));
}
