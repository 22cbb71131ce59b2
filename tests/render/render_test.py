"""`hapticgiant render`: what its pictures and videos show, and what it says when it cannot.

    render_test.py BUILD PROGRAM

Draws in Chromium without graphics hardware, so that the pictures are small. 77: the extra `render` cannot be had here.
"""

import hashlib
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np
from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/packages"))
from environment import make_environment  # noqa: E402

BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
SMALL = ("--size", "320x180")
WITHOUT = {**os.environ, "HAPTICGIANT_PYTHON": sys.executable}
PATIENCE_S = 500

venv = BUILD.parent / "render_venv"
if why := make_environment(venv, ROOT / "tools/requirements-render.txt"):
    print(f"skipped: {why}")
    sys.exit(77)
WITH = {**os.environ, "HAPTICGIANT_PYTHON": str(venv / "bin/python")}
FFMPEG = str(next(venv.glob("lib/python3*/site-packages/imageio_ffmpeg/binaries/ffmpeg*")))


def run(*words, env=WITH, cwd=None):
    return subprocess.run([PROGRAM, *map(str, words)], env=env, cwd=cwd, capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, timeout=PATIENCE_S)


def share(picture, hue, width=14, saturation=90):
    """Of the pixels that have nearly this hue, 0..255."""
    hues, saturations, _ = np.moveaxis(np.asarray(picture.convert("HSV")).astype(int), 2, 0)
    return float(np.mean((abs(hues - hue) < width) & (saturations > saturation)))


def difference(one, other):
    return float(np.mean(abs(np.asarray(one.convert("RGB")).astype(float) - np.asarray(other.convert("RGB")))))


class Render(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        kept = tempfile.TemporaryDirectory()
        cls.addClassCleanup(kept.cleanup)
        cls.folder = pathlib.Path(kept.name)
        run("run", "door", "--fast", "--no-viewer", "--duration", "7", "--recordings", cls.folder / "recordings")
        cls.recording = next((cls.folder / "recordings").glob("door*.mcap"))

    def render(self, name, *options, recording=None):
        """The file, which must have been written."""
        file = self.folder / name
        done = run("render", recording or self.recording, "-o", file, *options)
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
        self.assertIn(f"{file}: ", done.stdout)
        return file

    def refusal(self, *words, code=2, env=WITH):
        """Its only line; nothing but what was there is there."""
        before = sorted(self.folder.iterdir())
        done = run("render", *words, env=env)
        self.assertEqual((done.returncode, done.stdout), (code, ""), done.stderr)
        self.assertEqual(sorted(self.folder.iterdir()), before)
        return done.stderr

    def frames(self, video):
        """(times, pictures) of a video."""
        shown = subprocess.run([FFMPEG, "-i", video, "-vf", "showinfo", "-f", "null", "-"], capture_output=True, text=True)
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([FFMPEG, "-loglevel", "error", "-i", video, f"{folder}/%03d.png"], check=True)
            pictures = [Image.open(file).copy() for file in sorted(pathlib.Path(folder).iterdir())]
        return [float(at) for at in re.findall(r"pts_time:([\d.]+)", shown.stderr)], pictures


class Pictures(Render):
    def test_has_the_size_that_was_asked_for_and_shows_robot_and_twin(self):
        with Image.open(self.render("still.png", *SMALL, "--from", "6")) as still:
            self.assertEqual((still.size, still.format), ((320, 180), "PNG"))
            self.assertGreater(share(still, 149), 0.01)  # the robot is blue
            self.assertGreater(share(still, 20), 0.03)  # the door is orange
        with Image.open(self.render("tall.png", "--size", "180x320", "--from", "6", "--hide", "device", "--hide", "twin",
                                    "--bare", "--theme", "dark")) as other:
            self.assertEqual(other.size, (180, 320))
            self.assertLess(share(other, 20), 0.005)
            self.assertLess(np.mean(other.convert("L")), 0.6 * np.mean(still.convert("L")))

    def test_a_wide_one_has_all_its_pixels(self):
        with Image.open(self.render("wide.png", "--size", "2000x128")) as wide:
            self.assertEqual(wide.size, (2000, 128))
            halved = wide.resize((1000, 64)).resize((2000, 128), Image.Resampling.NEAREST)
            self.assertGreater(difference(wide, halved), 0.5)  # no picture of half the size

    def test_is_the_same_each_time_but_not_from_elsewhere(self):
        files = [self.render(f"same_{i}.png", *SMALL, "--from", "3", "--bare") for i in (1, 2)]
        self.assertEqual(*[hashlib.sha256(file.read_bytes()).hexdigest() for file in files])
        views = [Image.open(files[0])]
        for i, view in enumerate(("top", "3,-3,2:0,0,1")):
            views.append(Image.open(self.render(f"view_{i}.png", *SMALL, "--from", "3", "--bare", "--view", view)))
        for i, one in enumerate(views):
            for other in views[:i]:
                self.assertGreater(difference(one, other), 5)


class Videos(Render):
    def test_has_a_frame_for_each_step_and_each_shows_its_time(self):
        video = self.render("second.mp4", *SMALL, "--from", "5", "--to", "6", "--rate", "10")
        times, pictures = self.frames(video)
        np.testing.assert_allclose(times, np.arange(10) / 10, atol=1e-3)
        self.assertEqual(pictures[0].size, (320, 180))
        still = Image.open(self.render("last.png", *SMALL, "--from", "5.9"))
        apart = [difference(still, picture) for picture in pictures]
        self.assertEqual(int(np.argmin(apart)), 9, apart)
        self.assertLess(apart[-1], 3)
        self.assertTrue(video.read_bytes().find(b"moov") < video.read_bytes().find(b"mdat"))  # begins before it is all there

    def test_slow_motion_and_webm(self):
        times, _ = self.frames(self.render("slow.webm", *SMALL, "--from", "5", "--to", "5.2", "--rate", "10", "--speed", "0.5"))
        np.testing.assert_allclose(times, np.arange(4) / 10, atol=2e-3)

    def test_a_gif_plays_for_ever_at_its_rate(self):
        with Image.open(self.render("door.gif", *SMALL, "--from", "5", "--to", "5.2")) as gif:
            self.assertEqual((gif.size, gif.n_frames, gif.info["loop"], gif.info["duration"]), ((320, 180), 4, 0, 50))


class Refusals(Render):
    def test_of_words(self):
        file = self.folder / "x.mp4"
        for words, expected in (
                (["no.mcap", "-o", file], "no.mcap: no such file\n"),
                ([self.recording, "-o", self.folder / "x.mpg"], "expected a name that ends with .mp4, .webm, .gif or .png"),
                ([self.recording, "-o", self.folder / "x"], "expected a name that ends with"),
                ([self.recording, "-o", self.folder / "no" / "x.png"], "no file can be written into"),
                ([self.recording], "required: -o/--out"),
                *(([self.recording, "-o", file, "--size", size], "expected WIDTHxHEIGHT")
                  for size in ("320", "320x", "0x180", "10000x180", "320x180x1", "big")),
                ([self.recording, "-o", file, "--size", "321x180"], "even numbers, got 321x180"),
                ([self.recording, "-o", file, "--rate", "0"], "expected a number from 1 to 120, got '0'"),
                ([self.recording, "-o", file, "--rate", "nan"], "expected a number from 1 to 120, got 'nan'"),
                ([self.recording, "-o", file, "--view", "topp"], "did you mean 'top'?"),
                ([self.recording, "-o", file, "--view=-1,2,3:-1,2,3"], "the eye is where it looks at"),
                ([self.recording, "-o", file, "--theme", "drak"], "did you mean 'dark'?"),
                ([self.recording, "-o", file, "--sise", "1x1"], "did you mean '--size'?"),
                ([self.recording, "-o", self.folder / "x.png", "--to", "3"], "a picture has one time")):
            said = self.refusal(*words)
            self.assertIn(expected, said)
            self.assertNotIn("Traceback", said)

    def test_of_what_the_recording_has_not(self):
        file = self.folder / "x.mp4"
        self.assertRegex(self.refusal(self.recording, "-o", file, "--from", "60"), r"--from: the recording has 0.0\d\d .. [67]")
        self.assertIn("expected more than 3 s", self.refusal(self.recording, "-o", file, "--from", "3", "--to", "3"))
        self.assertIn("did you mean 'person'?", self.refusal(self.recording, "-o", file, "--hide", "persn"))
        wrong = self.folder / "wrong.mcap"
        wrong.write_text("no recording")
        self.assertIn("wrong.mcap", self.refusal(wrong, "-o", file))

    def test_names_what_is_missing(self):
        still, video = self.folder / "x.png", self.folder / "x.mp4"
        self.assertIn("pip install 'hapticgiant[render]'", self.refusal(self.recording, "-o", still, env=WITHOUT))
        self.assertIn("pip install 'hapticgiant[render]'", self.refusal(self.recording, "-o", video, env=WITHOUT | {"PATH": ""}))
        none = WITH | {"CHROMIUM": "/no/chromium"}
        said = self.refusal(self.recording, "-o", still, env=none)
        self.assertIn("Chromium is missing: apt install chromium", said)
        self.assertEqual(said.count("\n"), 1, said)
        self.assertIn("/bin/false: ", self.refusal(self.recording, "-o", still, env=WITH | {"CHROMIUM": "/bin/false"}, code=1))

    def test_replaces_files_as_a_whole_and_follows_no_link(self):
        kept, link = self.folder / "kept.png", self.folder / "link.png"
        kept.write_text("kept")
        link.symlink_to(kept)
        self.assertIn("expected a new name or a regular file", self.refusal(self.recording, "-o", link))
        self.assertIn("CHROMIUM", self.refusal(self.recording, "-o", kept, env=WITH | {"CHROMIUM": "/no/chromium"}))
        self.assertEqual(kept.read_text(), "kept")
        self.render("kept.png", *SMALL)
        self.assertTrue(kept.read_bytes().startswith(b"\x89PNG"))
        self.assertEqual(kept.stat().st_mode & 0o077, (self.folder / "recordings").stat().st_mode & 0o066)

    def test_an_interrupted_one_leaves_nothing(self):
        before = sorted(self.folder.iterdir())
        for number in (signal.SIGINT, signal.SIGTERM):
            process = subprocess.Popen([PROGRAM, "render", self.recording, "-o", self.folder / "x.mp4"], env=WITH,
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True)
            while len(sorted(self.folder.iterdir())) == len(before) and process.poll() is None:
                time.sleep(0.1)
            process.send_signal(number)
            out, err = process.communicate(timeout=PATIENCE_S)
            self.assertEqual((process.returncode, out, err), (130, "", ""))
            self.assertEqual(sorted(self.folder.iterdir()), before)


if __name__ == "__main__":
    unittest.main()
