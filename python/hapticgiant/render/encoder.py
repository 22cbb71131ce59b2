"""PNG pictures into a file: as they are, or by FFmpeg, a program of its own."""

from __future__ import annotations

import contextlib
import os
import pathlib
import shutil
import stat
import subprocess
import tempfile

from hapticgiant.render.errors import MissingPart, RenderError, RenderFailure

QUIET = ["-hide_banner", "-loglevel", "error", "-y"]
BT709 = ["-vf", "scale=out_color_matrix=bt709:out_range=tv", "-pix_fmt", "yuv420p", "-colorspace", "bt709",
         "-color_primaries", "bt709", "-color_trc", "bt709"]
SAME = ["-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact"]  # no date, no version
CODECS = {".mp4": [*BT709, "-c:v", "libx264", "-preset", "slow", "-crf", "18", "-movflags", "+faststart", *SAME],
          ".webm": [*BT709, "-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1", *SAME]}
# the colours of all pictures first, then each pixel; only what has changed is written
GIF = ("split[a][b];[a]palettegen=max_colors=256:stats_mode=diff[p];"
       "[b][p]paletteuse=dither=bayer:bayer_scale=5:diff_mode=rectangle")


@contextlib.contextmanager
def whole_file(name):
    """A file beside `name` that takes its place at the end, unless something was raised."""
    target = pathlib.Path(name)
    with contextlib.suppress(FileNotFoundError):
        if not stat.S_ISREG(os.lstat(target).st_mode):
            raise RenderError(f"{name}: expected a new name or a regular file, which is replaced as a whole")
    folder = target.parent
    if not (folder.is_dir() and os.access(folder, os.W_OK)):
        raise RenderError(f"{name}: no file can be written into {folder}")
    descriptor, partial = tempfile.mkstemp(prefix=f".{target.name}.", suffix=target.suffix, dir=folder)
    os.close(descriptor)
    try:
        yield pathlib.Path(partial)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(partial, 0o666 & ~mask)
        os.replace(partial, target)
    finally:
        pathlib.Path(partial).unlink(missing_ok=True)


def ffmpeg():
    """The program: of imageio-ffmpeg, or of the system."""
    try:
        import imageio_ffmpeg
        return imageio_ffmpeg.get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        found = shutil.which("ffmpeg")
    if found is None:
        raise MissingPart("ffmpeg is missing: pip install 'hapticgiant[render]', or apt install ffmpeg")
    return found


def run_ffmpeg(command, pictures=()):
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        try:
            with contextlib.suppress(BrokenPipeError):  # its words say why
                for picture in pictures:
                    process.stdin.write(picture)
                process.stdin.close()
            said = process.stderr.read().decode(errors="replace")
        except BaseException:
            process.kill()
            raise
    if process.returncode != 0:
        raise RenderFailure(f"ffmpeg: {said.strip() or f'ended with {process.returncode}'}")


def of(ending):
    """The function write(file, pictures, rate) for files with this ending. Raises MissingPart."""
    if ending == ".png":
        return write_png
    program = ffmpeg()

    def pipe(file, pictures, rate, codec):
        source = ["-f", "image2pipe", "-c:v", "png", "-framerate", f"{rate:g}", "-i", "-"]
        run_ffmpeg([program, *QUIET, *source, *codec, str(file)], pictures)

    def write_video(file, pictures, rate):
        pipe(file, pictures, rate, CODECS[ending])

    def write_gif(file, pictures, rate):
        with tempfile.TemporaryDirectory(prefix="hapticgiant_render_") as folder:
            kept = pathlib.Path(folder) / "pictures.mkv"  # as they are: the palette needs all of them
            pipe(kept, pictures, rate, ["-c:v", "copy"])
            run_ffmpeg([program, *QUIET, "-i", str(kept), "-vf", GIF, "-loop", "0", *SAME, str(file)])
    return write_gif if ending == ".gif" else write_video


def write_png(file, pictures, _rate):
    file.write_bytes(next(iter(pictures)))
