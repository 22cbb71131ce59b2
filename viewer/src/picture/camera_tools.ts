// How the scene is seen, in the bar: camera and layers.

import { hand_words } from "../hand/hand_words";
import { icon } from "../icons";
import { element, is_typing, make, make_check_box } from "../page";
import { remembered, remember } from "../remembered";
import { view_text } from "../scene/asked_view";
import { type Cameras, VIEWS, type View } from "../scene/cameras";
import { LAYERS, LAYER_NAMES, type Layers } from "../scene/layers";

const STORED_AS = "hapticgiant.view";

export class CameraTools {
  private readonly views = make("select");

  constructor(
    private readonly cameras: Cameras,
    layers: Layers,
    private readonly say: (text: string) => void,
  ) {
    this.views.id = "view";
    this.views.title = "Camera (1 to 4)";
    this.views.setAttribute("aria-label", "Camera");
    this.views.append(...VIEWS.map((view) => new Option(hand_words()[view], view)));
    this.views.addEventListener("change", () => this.choose(this.views.value as View));
    addEventListener("keydown", (event) => {
      const view = VIEWS[Number(event.key) - 1];
      if (view && !is_typing(event)) this.choose(view);
      else if (event.key === "v" && !is_typing(event)) void this.copy();
    });
    element("view-tools").prepend(this.views, layers_menu(layers));
  }

  // The first camera of a device; null: as it was chosen last.
  begin(view: View | null): void {
    const first = view ?? remembered(STORED_AS, VIEWS, "orbit");
    this.views.value = first;
    if (first !== "orbit") this.cameras.choose(first);
  }

  // The option of `hapticgiant render` that looks from here.
  private async copy(): Promise<void> {
    const option = `--view=${view_text(this.cameras.sight)}`;
    const is_copied = await navigator.clipboard?.writeText(option).then(() => true, () => false);
    this.say(is_copied ? `Copied: ${option}` : option);
  }

  private choose(view: View): void {
    this.views.value = view;
    this.cameras.choose(view);
    remember(STORED_AS, view);
  }
}

function layers_menu(layers: Layers): HTMLElement {
  const list = make("div", "menu");
  for (const name of LAYER_NAMES) {
    const box = make_check_box(LAYERS[name].title, layers.is_shown(name), (is_shown) =>
      layers.show(name, is_shown),
    );
    box.querySelector("input")!.id = `show-${name}`;
    list.append(box);
  }
  const head = make("summary", "icon-button");
  head.title = "What is shown";
  head.setAttribute("aria-label", head.title);
  head.append(icon("layers"));
  const menu = make("details", "menu-box", head, list);
  menu.id = "layers";
  addEventListener("pointerdown", (event) => {
    if (!menu.contains(event.target as Node)) menu.open = false;
  });
  return menu;
}
