import { expect, it } from "vitest";

import { holder_text, is_taken } from "../../src/hand/holder_note";

const OWN = 3;

it("the hand is taken when another page has it", () => {
  expect(is_taken({ hand_page: 0 }, OWN)).toBe(false);
  expect(is_taken({ hand_page: OWN }, OWN)).toBe(false);
  expect(is_taken({ hand_page: 1 }, OWN)).toBe(true);
  expect(is_taken(null, OWN)).toBe(false);
});

it("each page reads who has the hand and who asks for it", () => {
  const text = (hand_page: number, hand_asked_by: number): string =>
    holder_text({ hand_page, hand_asked_by }, OWN);
  expect(text(0, 0)).toBe("");
  expect(text(1, 0)).toBe("Page 1 has the hand.");
  expect(text(1, OWN)).toBe("Page 1 has the hand. You have asked for it.");
  expect(text(OWN, 0)).toBe("");
  expect(text(OWN, 2)).toBe("Page 2 asks for the hand: let go to give it.");
});
