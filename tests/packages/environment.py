"""What tests run against: environments of Python for software that nothing of ours is linked to, and
devices whose run does not end because this computer is busy."""

import shutil
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


def that_lets_late_cycles_pass(file, folder):
    """A copy of this device.yaml and of what lies beside it, in `folder`, without rule 203."""
    copy = shutil.copytree(file.parent, folder / file.parent.name, dirs_exist_ok=True) / file.name
    text = copy.read_text()
    if "\nmonitor:\n" not in text:
        text += "\nmonitor:\n"
    keys = "".join(f"  {key}: 100000\n" for key in ("overruns_in_a_row", "overruns_per_s"))
    copy.write_text(text.replace("\nmonitor:\n", "\nmonitor:\n" + keys))
    return copy
