// Words beside the handle, which a participant of a study reads: in the language of the address,
// `language=de` after the token, else in English.

import { page_options } from "../data/token";

const ENGLISH = {
  drag: "Drag:",
  plane: "level",
  z: "up / down",
  turn: "turn",
  press: "press lever",
  automatic: "while dragging",
  me: "Drag me",
  door: "Drag me: push the door open",
  dig: "Drag me: dig",
  stopped: "Stopped. Please wait for the operator.",
  orbit: "orbit",
  follow: "follow",
  top: "top",
  "first person": "first person",
};

const GERMAN: typeof ENGLISH = {
  drag: "Ziehen:",
  plane: "waagrecht",
  z: "auf / ab",
  turn: "drehen",
  press: "Klinke drücken",
  automatic: "beim Ziehen",
  me: "Hier ziehen",
  door: "Hier ziehen: Tür aufdrücken",
  dig: "Hier ziehen: graben",
  stopped: "Angehalten. Bitte warten Sie auf die Versuchsleitung.",
  orbit: "von der Seite",
  follow: "mitgehend",
  top: "von oben",
  "first person": "mit eigenen Augen",
};

export function hand_words(): typeof ENGLISH {
  return page_options().get("language") === "de" ? GERMAN : ENGLISH;
}
