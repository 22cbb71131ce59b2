// The picture that this browser can draw.

import { page_options } from "../data/token";
import { FlatPicture } from "./flat_picture";
import type { Picture, PictureInput } from "./picture";
import { SpacePicture } from "./space_picture";
import { no_space_text, why_no_space } from "./webgl";

const ASKED = "No 3-D picture: the address asks for the flat one.";

export function open_picture(input: PictureInput): Picture {
  if (page_options().get("picture") === "flat") return new FlatPicture(ASKED, input);
  const reason = why_no_space();
  if (reason !== "") return new FlatPicture(reason, input);
  try {
    return new SpacePicture(input);
  } catch (error) {
    return new FlatPicture(no_space_text(error instanceof Error ? error.message : ""), input);
  }
}
