// First steps, legend and glossary of the page. Each case gets {browser, program, expect}, as those of
// cases.mjs.
import { violations } from "../study/axe.mjs";
import { cheap, open_page, page_comes_to } from "./browser.mjs";

export async function first_steps_stay_dismissed({ browser, program, expect }) {
  const { page, close } = await open_page(browser, cheap(program.link));
  const sentences = await page.locator("#guide li").allInnerTexts();
  expect(sentences.length === 3 && /robot/.test(sentences[0]), `three sentences: ${sentences.join(" / ")}`);
  await page.click("#guide button:visible >> text=Got it");
  expect((await page.locator("#guide").count()) === 0, "they go when they are dismissed");
  await page.reload();
  await page.waitForFunction(() => window.hapticgiant?.frame);
  expect((await page.locator("#guide").count()) === 0, "and stay away");
  await close();
  const phone = { viewport: { width: 390, height: 844 } };
  const small = await open_page(browser, cheap(program.link), phone);
  const seen = [];
  for (const button of ["Next", "Next", "Got it"]) {
    seen.push(...(await small.page.locator("#guide li:visible").allInnerTexts()));
    await small.page.click(`#guide button:visible >> text=${button}`);
  }
  expect(seen.join() === sentences.join(), `on a phone one after the other: ${seen.length}`);
  await small.close();
}

export async function legend_follows_layers({ browser, program, expect }) {
  const { page, close } = await open_page(browser, cheap(program.link));
  const lines = () => page.locator("#legend li:visible").allInnerTexts();
  const all = await lines();
  for (const text of ["robot (device)", "twin", "force on the hand", "way of the handle"])
    expect(all.includes(text), `the legend has ${text}`);
  await page.locator("#show-trails").evaluate((box) => box.click());
  const fewer = await lines();
  expect(!fewer.some((line) => line.startsWith("way")), `without what is not shown: ${fewer.join(", ")}`);
  const colors = await page.locator("#legend li:visible i").evaluateAll((marks) => marks.slice(0, 3).map((mark) => mark.style.color));
  expect(new Set(colors).size === 3, `device, twin and force differ: ${colors.join(" ")}`);
  await close();
}

export async function words_open_the_glossary({ browser, program, expect }) {
  const { page, problems, close } = await open_page(browser, cheap(program.link));
  for (const tab of ["feel", "joints", "change", "safety"]) {
    await page.click(`#tab-${tab}`);
    const terms = await page.locator(`#${tab} .term:visible`).allInnerTexts();
    expect(terms.length > 0, `${tab}: ${[...new Set(terms)].join(", ")}`);
  }
  expect((await page.locator("#tabs .term").count()) === 0, "the tabs stay as they are");
  await page.click("#tab-feel");
  const text = () => page.locator("#glossary").innerText();
  await page.locator("#feel .budget .term").first().click();
  expect((await text()).startsWith("mass"), "a click on a word opens its meaning");
  await page.click("#glossary >> text=Close");
  const is_shut = await page_comes_to(page, () => !document.getElementById("glossary").matches(":popover-open"));
  expect(is_shut, "and it closes");
  await page.locator("#feel .budget .term >> text=damping").focus();
  await page.keyboard.press("Enter");
  expect((await text()).startsWith("damping"), "as do keys");
  const found = (await violations(page)).filter((text) => /term|glossary|guide|legend/.test(text));
  expect(found.length === 0, `axe finds nothing in it: ${found.join("; ") || "nothing"}`);
  await page.click("#glossary >> text=All words");
  expect((await page.locator("#glossary dt").count()) > 30, "and all words are listed");
  expect(problems.length === 0, `no errors: ${problems.join("; ") || "none"}`);
  await close();
}
