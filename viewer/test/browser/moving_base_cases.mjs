// A twin on a base that moves: both are drawn where the base has carried them. Each case gets
// {browser, command, expect}, as those of cases.mjs; none needs the shared program.
import {
  NO_SPACE,
  cheap,
  comes_true,
  count_different,
  frame_of,
  hide_and_compare,
  open_page,
  page_comes_to,
  pictures,
  start_browser,
  start_program,
} from "./browser.mjs";

const SMALLEST = { base: 2000, moved: 400, flat: 150 }; // pixels

async function with_ship({ command, expect }, use) {
  if (!command.includes("run")) return; // the demonstration server has no moving base
  const program = await start_program([command[0], "run", "ship", "--user", "mouse", "--no-recording"]);
  await use(program);
  await program.stop();
}

// A picture of the scene, and the frame that it shows, when the base is `away` from where it rests.
async function still_when(page, is_away) {
  await comes_true(page, (f) => f.mode === "running" && f.twin_base !== null && is_away(f.twin_base));
  await page.click("#pause");
  await comes_true(page, (f) => f.run_state.is_paused);
  await pictures(page);
  const { x, y, width, height } = await page.locator("#stage").boundingBox();
  const picture = await page.screenshot({ clip: { x, y: y + 70, width, height: height - 140 } });
  const frame = await frame_of(page);
  await page.click("#pause");
  await comes_true(page, (f) => !f.run_state.is_paused);
  return { picture: picture.toString("base64"), frame };
}

export async function a_moving_base_carries_the_twin({ browser, command, expect }) {
  await with_ship({ command, expect }, async (program) => {
    const { page, problems, close } = await open_page(browser, cheap(program.link));
    const pixels = await hide_and_compare(page, "base");
    expect(pixels >= SMALLEST.base, `what carries the twin covers ${pixels} pixels`);
    await page.click("#tab-feel");
    const said = await page_comes_to(page, () =>
      /^What carries the twin moves \([1-9]\d* mm and \d+\.\d\u00b0/.test(document.querySelector("#twin-base").textContent));
    expect(said, `the panel says so: ${await page.textContent("#twin-base")}`);

    // the locked door alone: what moves it in the picture is its base
    await page.evaluate(() => {
      for (const box of document.querySelectorAll("#layers input")) {
        if (box.checked !== (box.id === "show-twin")) box.click();
      }
      for (const part of document.querySelectorAll("#stage-area > :not(#stage)")) part.style.display = "none";
    });
    const velocity = (sign) => (base) => sign * base.v_m_per_s[2] > 0 && Math.abs(base.v_m_per_s[2]) < 0.01;
    const high = await still_when(page, velocity(1));
    const low = await still_when(page, velocity(-1));
    const count = await page.evaluate(count_different, [high.picture, low.picture, high.picture]);
    const way = Math.hypot(...high.frame.twin_base.p_B_m.map((x, i) => x - low.frame.twin_base.p_B_m[i]));
    const turned = Math.abs(high.frame.q_twin[0] - low.frame.q_twin[0]);
    const size = `${(1000 * way).toFixed(0)} mm, the door by ${turned.toFixed(3)} rad`;
    expect(way > 0.01 && turned < 0.01, `the base moves by ${size}`);
    expect(count > SMALLEST.moved, `and the twin in the picture: ${count} pixels`);
    expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
    await close();
  });
}

export async function a_moving_base_is_drawn_without_webgl({ command, expect }) {
  await with_ship({ command, expect }, async (program) => {
    const browser = await start_browser(NO_SPACE);
    const { page, problems } = await open_page(browser, cheap(program.link));
    const found = await page.evaluate(() => {
      const [r, g, b] = [0x8a, 0x5a, 0x2b]; // --base of the light theme
      return [...document.querySelectorAll(".flat canvas")].map((canvas) => {
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        let count = 0;
        for (let i = 0; i < data.length; i += 4) {
          if (data[i + 3] > 60 && Math.hypot(data[i] - r, data[i + 1] - g, data[i + 2] - b) < 40) count += 1;
        }
        return count;
      });
    });
    expect(found.length === 2 && found.every((count) => count > SMALLEST.flat), `both views have it: ${found} pixels`);
    expect(problems.length === 0, `no errors or foreign requests: ${problems.join("; ") || "none"}`);
    await browser.close();
  });
}
