"""Environments of Python for software that tests run against and nothing of ours is linked to."""

import subprocess
import sys


def make_environment(folder, requirements):
    """Installs `requirements` into `folder` where they have changed; why not, or nothing."""
    wanted, made = requirements.read_text(), folder / "requirements.txt"
    if made.exists() and made.read_text() == wanted:
        return ""
    try:
        subprocess.run([sys.executable, "-m", "venv", "--clear", folder], check=True,
                       capture_output=True, text=True)
        subprocess.run([folder / "bin" / "python", "-m", "pip", "install", "--quiet", "--retries",
                        "1", "--timeout", "15", "--requirement", requirements], check=True,
                       capture_output=True, text=True)
    except (OSError, subprocess.CalledProcessError) as error:
        words = (getattr(error, "stderr", "") or str(error)).strip()
        return words.splitlines()[-1]
    made.write_text(wanted)
    return ""
