"""Command line of `hapticgiant render`; docs/start/viewer.md.

Exit codes: 0 rendered, 1 the browser or the encoder failed, 2 bad input, 130 ended by Ctrl-C.
"""

from __future__ import annotations

import argparse
import math
import pathlib
import re
import signal
import sys
import time

if not __package__:
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
    import as_folder  # noqa: F401

ENDINGS = (".mp4", ".webm", ".gif", ".png")
RATES = {".gif": 20.0}  # frames a second; of the others: 30
RATE = 30.0
MOST_RATE = 120.0
LEAST_PIXELS, MOST_PIXELS = 64, 4096
FAILED = 1  # exit code
EXTRA = "pip install 'hapticgiant[render]'"


def number(low, high, what):
    def found(text):
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"expected {what}, got '{text}'")
        return value
    return found


def size(text):
    words = re.fullmatch(r"(\d{1,5})x(\d{1,5})", text)
    pixels = tuple(map(int, words.groups())) if words else (0, 0)
    if not all(LEAST_PIXELS <= count <= MOST_PIXELS for count in pixels):
        raise argparse.ArgumentTypeError(
            f"expected WIDTHxHEIGHT with {LEAST_PIXELS} to {MOST_PIXELS} pixels each, as 1920x1080, got '{text}'")
    return pixels


def parser():
    from hapticgiant.command_line import Parser

    found = Parser(
        prog="hapticgiant render", description="A recording as a video, a GIF or a picture, as `hapticgiant replay "
        "--view` shows it (docs/start/viewer.md).")
    found.add_argument("recording", metavar="RECORDING", help="recording of hapticgiant run")
    found.add_argument("-o", "--out", required=True, metavar="FILE", help="what is written: .mp4, .webm, .gif or .png")
    second = number(-math.inf, math.inf, "seconds")
    group = found.add_argument_group("time")
    group.add_argument("--from", dest="begin", type=second, metavar="S",
                       help="time of the run, as the page shows it; of a picture: its time; default: the beginning")
    group.add_argument("--to", dest="end", type=second, metavar="S", help="default: the end")
    group.add_argument("--rate", type=number(1, MOST_RATE, f"a number from 1 to {MOST_RATE:g}"), metavar="FPS",
                       help=f"frames a second; default: {RATE:g}, of a GIF {RATES['.gif']:g}")
    group.add_argument("--speed", type=number(0.1, 8, "a number from 0.1 to 8"), default=1.0, metavar="X",
                       help="recorded seconds per second; default: 1")
    group = found.add_argument_group("picture")
    group.add_argument("--size", type=size, default=(1280, 720), metavar="WxH",
                       help=f"pixels, each at most {MOST_PIXELS}; default: 1280x720")
    group.add_argument("--view", default="first", metavar="VIEW",
                       help="first (default), follow, top, first-person; or X,Y,Z:X,Y,Z, an eye and the point it looks "
                            "at, m: key V of the page copies that of its camera")
    group.add_argument("--theme", choices=("light", "dark"), default="light")
    group.add_argument("--hide", action="append", default=[], metavar="LAYER",
                       help="without this layer of the page, as person or box; may be given several times")
    group.add_argument("--bare", action="store_true", help="without time and legend")
    group.add_argument("--compare", metavar="RECORDING", help="a second recording, drawn through the first")
    return found


def checked(options):
    """The ending of the output, once files and options fit together. Raises RenderError."""
    from hapticgiant.command_line import nearest
    from hapticgiant.render.errors import RenderError

    ending = pathlib.Path(options.out).suffix.lower()
    if ending not in ENDINGS:
        raise RenderError(f"{options.out}: expected a name that ends with {', '.join(ENDINGS[:-1])} or {ENDINGS[-1]}"
                          + (f"; did you mean '{nearest(ending, ENDINGS)}'?" if ending else ""))
    for file in filter(None, (options.recording, options.compare)):
        if not pathlib.Path(file).is_file():
            raise RenderError(f"{file}: no such file")
    if ending == ".png":
        for name, value in (("--to", options.end), ("--rate", options.rate)):
            if value is not None:
                raise RenderError(f"{name}: a picture has one time, that of --from; expected a video or a GIF")
    if ending in (".mp4", ".webm") and any(count % 2 for count in options.size):
        raise RenderError(f"--size: a video needs even numbers, got {options.size[0]}x{options.size[1]}")
    return ending


def span(options, begin_s, end_s, is_still):
    """From when to when, of a recording from begin_s to end_s. Raises RenderError."""
    from hapticgiant.render.errors import RenderError

    slack = 1e-3
    begin = begin_s if options.begin is None else options.begin
    end = begin if is_still else end_s if options.end is None else options.end
    for name, value in (("--from", begin), ("--to", end)):
        if not begin_s - slack <= value <= end_s + slack:
            raise RenderError(f"{name}: the recording has {begin_s:.3f} .. {end_s:.3f} s, got {value:g}")
    if not is_still and end <= begin:
        raise RenderError(f"--to: expected more than {begin:g} s, where it begins, got {end:g}")
    return max(begin, begin_s), min(end, end_s)


def times(begin, end, rate, speed):
    """Of the frames of a video, in time of the run."""
    count = max(1, round((end - begin) / speed * rate))
    return [min(end, begin + i * speed / rate) for i in range(count)]


def render(options):
    from hapticgiant.render import encoder
    from hapticgiant.render.film import Film

    ending = checked(options)
    rate = options.rate or RATES.get(ending, RATE)
    encode = encoder.of(ending)  # says now whether it can
    started = time.monotonic()
    with encoder.whole_file(options.out) as file, Film(options) as film:
        begin, end = span(options, film.begin_s, film.end_s, ending == ".png")
        wanted = [begin] if ending == ".png" else times(begin, end, rate, options.speed)
        film.come_to(begin)
        encode(file, progress((film.picture(at) for at in wanted), len(wanted)), rate)
    width, height = options.size
    frames = "a picture" if ending == ".png" else f"{len(wanted)} frames, {len(wanted) / rate:.2f} s"
    megabytes = pathlib.Path(options.out).stat().st_size / 1e6
    print(f"{options.out}: {width}x{height}, {frames}, {megabytes:.2f} MB, drawn in {time.monotonic() - started:.1f} s")
    return 0


def progress(pictures, count):
    """The same pictures, counted on a terminal."""
    is_seen = sys.stderr.isatty()
    for done, picture in enumerate(pictures, 1):
        if is_seen:
            print(f"\rframe {done} of {count}", end="" if done < count else "\n", file=sys.stderr, flush=True)
        yield picture


def interrupt(*_):
    raise KeyboardInterrupt


def main(words):
    from hapticgiant.command_line import BAD_INPUT, INTERRUPTED, exit_code_of
    from hapticgiant.render.errors import MissingPart, RenderError, RenderFailure

    options = parser().parse_args(words)
    signal.signal(signal.SIGTERM, interrupt)
    try:
        return exit_code_of("render", lambda: render(options), (RenderError,))
    except MissingPart as error:
        print(f"render: {sys.executable}: {error}", file=sys.stderr)
        return BAD_INPUT
    except RenderFailure as error:
        print(f"render: {error}", file=sys.stderr)
        return FAILED
    except KeyboardInterrupt:
        return INTERRUPTED


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
