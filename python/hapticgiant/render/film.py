"""Pictures of a recording at given times: `hapticgiant replay --view`, opened in a headless Chromium.

The page draws when it is asked to, not by the clock (viewer/src/film.ts): the same recording gives the same
pictures on any computer with the same browser, however slow it is.
"""

from __future__ import annotations

import base64
import contextlib
import importlib.util
import os
import re
import shutil
import subprocess
import time
import urllib.parse

from hapticgiant.command_line import nearest
from hapticgiant.render.errors import MissingPart, RenderError, RenderFailure

PATIENCE_MS = 180_000  # without graphics hardware a large picture takes seconds
TRAIL_S, TRAIL_STEP_S = 6.0, 0.05  # what is passed before the first picture, so that it has trails
SHARP = 1920  # pixels; wider ones are drawn with as many points of the page, each of two by two pixels
FLAGS = ["--disable-background-networking", "--disable-component-update", "--disable-quic", "--disable-sync",
         "--no-first-run", "--hide-scrollbars", "--force-color-profile=srgb",
         "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]  # needs no graphics hardware
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
VIEWS = {"first": "orbit", "follow": "follow", "top": "top", "first-person": "first-person"}
PLACE = re.compile(r"(-?[\d.]+,){2}-?[\d.]+:(-?[\d.]+,){2}-?[\d.]+")
LINK = re.compile(r"http://127\.0\.0\.1:\d+/#token=[0-9a-f]+")
IS_DRAWABLE = """() => {
  const page = window.hapticgiant;
  return Boolean(page?.is_connected && page.frame && page.film && page.is_drawn);
}"""


def view_option(text):
    """As the address of the page has it. Raises RenderError."""
    if text in VIEWS:
        return VIEWS[text]
    if not PLACE.fullmatch(text):
        raise RenderError(f"--view: expected {', '.join(VIEWS)} or X,Y,Z:X,Y,Z, got '{text}'; did you mean "
                          f"'{nearest(text, VIEWS)}'?")
    eye, _, at = text.partition(":")
    if eye == at:
        raise RenderError(f"--view: the eye is where it looks at: '{text}'")
    return text


class Film(contextlib.AbstractContextManager):
    """A recording, opened in a browser of its own."""

    def __init__(self, options):
        if importlib.util.find_spec("playwright") is None:
            raise MissingPart("playwright is missing: pip install 'hapticgiant[render]'")
        self.options = options
        self.view = view_option(options.view)
        width, height = options.size
        self.scale = 2 if width > SHARP and width % 2 == 0 and height % 2 == 0 else 1
        self.ends = contextlib.ExitStack()
        self.begin_s = self.end_s = 0.0

    def __enter__(self):
        with contextlib.ExitStack() as on_error:
            on_error.push(self.__exit__)
            self.session = self._open(self._replay())
            on_error.pop_all()
        return self

    def __exit__(self, _kind, error, _where):
        self.ends.close()
        if type(error).__module__.startswith("playwright"):
            raise RenderFailure(f"the browser: {error}") from error

    def come_to(self, time_s):
        """Lets the page pass what comes before the first picture."""
        self._ask("pass", self.begin_s)  # the first view is chosen there, as in the page
        steps = int(min(TRAIL_S, time_s - self.begin_s) / TRAIL_STEP_S)
        for step in range(steps, -1, -1):
            self._ask("pass", max(self.begin_s, time_s - step * TRAIL_STEP_S))

    def picture(self, time_s):
        """PNG of this time of the run."""
        self._ask("draw", time_s)
        width, height = (pixels / self.scale for pixels in self.options.size)
        taken = self.session.send("Page.captureScreenshot", {
            "format": "png", "optimizeForSpeed": True,
            "clip": {"x": 0, "y": 0, "width": width, "height": height, "scale": self.scale}})
        return base64.b64decode(taken["data"])

    def _ask(self, what, time_s):
        self.page.evaluate(f"time_s => window.hapticgiant.film.{what}(time_s)", time_s)

    def _replay(self):
        """Starts the program; returns the link of its page."""
        command = [os.environ.get("HAPTICGIANT_PROGRAM", "hapticgiant"), "replay", self.options.recording, "--view",
                   "--no-browser", *(["--compare", self.options.compare] if self.options.compare else [])]
        program = self.ends.enter_context(subprocess.Popen(command, text=True, stdin=subprocess.DEVNULL,
                                                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT))
        self.ends.callback(program.kill)
        said = []
        for line in program.stdout:
            said.append(line)
            if found := LINK.search(line):
                return found[0]
        code = program.wait()
        last = "".join(said[-3:]).strip()
        raise (RenderError if code == 2 else RenderFailure)(last or f"hapticgiant replay: exit code {code}")

    def _open(self, link):
        self.page = self._browser_page()
        words = "&words=none" if self.options.bare else ""
        view = urllib.parse.quote(self.view, safe=",:")
        self.page.goto(f"{link}&quality=best&show=picture&view={view}{words}", wait_until="commit")
        self._wait_until_drawable()
        self._hide_layers()
        scene = self.page.evaluate("(({begin_s, duration_s}) => [begin_s, duration_s])(window.hapticgiant.scene)")
        self.begin_s, self.end_s = scene[0], scene[0] + scene[1]
        return self.page.context.new_cdp_session(self.page)

    def _wait_until_drawable(self):
        end = time.monotonic() + PATIENCE_MS / 1000
        while not self.page.evaluate(IS_DRAWABLE):  # the page allows no code of others, as wait_for_function needs
            if time.monotonic() > end:
                raise RenderFailure("the page does not draw the recording")
            self.page.wait_for_timeout(50)

    def _browser_page(self):
        from playwright.sync_api import Error, sync_playwright

        playwright = self.ends.enter_context(sync_playwright())
        # of the system, or the one that playwright installs
        chosen = os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, BROWSERS)), None)
        flags = [*FLAGS, *(["--no-sandbox"] if os.geteuid() == 0 else [])]
        try:
            browser = playwright.chromium.launch(executable_path=chosen, args=flags, handle_sigint=False)
        except Error as error:
            if chosen and os.access(chosen, os.X_OK):
                raise RenderFailure(f"{chosen}: is no Chromium that starts: {str(error).splitlines()[0]}") from None
            raise MissingPart("Chromium is missing: apt install chromium, or python -m playwright install chromium; the "
                              f"variable CHROMIUM names another place{f', and {chosen} is none' if chosen else ''}") from None
        self.ends.callback(browser.close)
        width, height = self.options.size
        context = browser.new_context(viewport={"width": width // self.scale, "height": height // self.scale},
                                      device_scale_factor=self.scale, color_scheme=self.options.theme)
        page = context.new_page()
        page.set_default_timeout(PATIENCE_MS)
        return page

    def _hide_layers(self):
        boxes = self.page.locator("#layers input").evaluate_all("all => all.map(box => box.id)")
        layers = [box.removeprefix("show-") for box in boxes]
        for name in self.options.hide:
            if name not in layers:
                raise RenderError(f"--hide: expected one of {', '.join(layers)}, got '{name}'; did you mean "
                                  f"'{nearest(name, layers)}'?")
            self.page.evaluate("id => { const box = document.getElementById(id); if (box.checked) box.click(); }",
                               f"show-{name}")
