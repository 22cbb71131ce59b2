#!/usr/bin/env python3
"""What would this feel like on my arm: Haptify and the shipped scenarios on every arm of models/arms, beside the HapticGiant.

Usage: compare_arms.py PROGRAM PAGE [FOLDER]   (minutes; refreshes the tables of PAGE and the CSV files beside it; the results stay in FOLDER, build/arms)
"""

import datetime
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tools/pages"))
from pages import as_csv, replace_marked  # noqa: E402

REFERENCE = "models/haptic_giant/device.yaml"
FIGURES = ("workspace_volume", "free_space_extra", "free_space_vibration", "latency", "force_bandwidth", "felt_mass_20",
           "stiffness_accuracy", "stiffness_peak_force", "z_width", "smallest_inertia", "spring_frequency")
SHOWN = ("free_space_extra", "latency", "felt_mass_20", "stiffness_peak_force")  # in the page itself
SCENARIOS = ("open_cupboard", "open_drawer", "move_tool")


def call(*arguments):
    result = subprocess.run([*map(str, arguments)], cwd=ROOT, text=True, capture_output=True, check=False)
    if result.returncode not in (0, 1):  # 1: not all that was hoped for
        sys.exit(f"{' '.join(map(str, arguments))}: exit code {result.returncode}\n{result.stderr}")


def haptify(program, device, folder):
    call(program, "haptify", "--quick", "--device", device, "--out", folder)
    return json.loads((folder / "figures.json").read_text())


def play(program, scenario, folder):
    summary = folder / f"{scenario.stem}.json"
    call(program, "run", scenario, "--fast", "--no-viewer", "--no-recording", "--summary", summary)
    return json.loads(summary.read_text())


def markdown(rows):
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join([lines[0], "| --- |" + " --- |" * (len(rows[0]) - 1), *lines[1:]]) + "\n"


def haptify_rows(figures, keys):
    found = {name: {entry["id"]: entry for entry in data["table"] + data["beyond"]} for name, data in figures.items()}
    rows = [["", "unit", *figures]]
    for key in keys:
        first = next(iter(found.values()))[key]
        rows.append([first["name"], first["unit"], *(entries[key]["measured"].strip() for entries in found.values())])
    return rows


def is_played(summary):
    return not summary["missing_events"] and summary["fault"]["code"] == 0


def scenario_rows(name, runs):
    rows = []
    for arm, summaries in runs.items():
        summary = summaries[name]
        reality = summary["reality"]
        excess = max((limit["worst_violation"] for limit in reality["limits"].values()), default=0.0)
        rows.append([name, arm, "yes" if is_played(summary) else "no", f"{summary['force']['mean_N']:.1f}",
                     f"{reality['vibration_above_5_Hz_m_per_s2']:.2f}", f"{1e3 * reality['max_handle_to_twin_m']:.1f}",
                     f"{1e3 * excess:.1f}", summary["plant"]])
    return rows


def failure_rows(figures):
    return [["arm", "what it could not do"]] + [[name, text.strip()] for name, data in figures.items()
                                                for text in [*data["impossible"], *data["failures"]]]


def refresh(page, figures, runs):
    """The short table of the page, and the files beside it."""
    scenarios = [["scenario", "arm", "opens and shuts", "mean force N", "vibration m/s^2", "handle off the twin mm",
                  "beyond a limit, mm or mrad", "drives"]]
    for scenario in SCENARIOS:
        scenarios += scenario_rows(scenario, runs)
    files = {"haptify": haptify_rows(figures, FIGURES), "failures": failure_rows(figures), "scenarios": scenarios}
    for name, rows in files.items():
        page.with_name(f"{page.stem}_{name}.csv").write_text(as_csv(rows))
    version = next(iter(runs.values()))[SCENARIOS[0]]["version"]
    short = f"{markdown(haptify_rows(figures, SHOWN))}\nVersion {version}, {datetime.date.today()}.\n"
    page.write_text(replace_marked(page.read_text(), "haptify", short))


def main():
    program, page = map(pathlib.Path, sys.argv[1:3])
    folder = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else ROOT / "build/arms"
    arms = {path.parent.name: path for path in sorted((ROOT / "models/arms").glob("*/device.yaml"))}
    figures, runs = {}, {}
    for name, device in {"haptic_giant": ROOT / REFERENCE, **arms}.items():
        own = folder.resolve() / name
        own.mkdir(parents=True, exist_ok=True)
        figures[name] = haptify(program.resolve(), device.relative_to(ROOT), own)
        if name in arms:
            runs[name] = {scenario: play(program.resolve(), device.parent / f"{scenario}.yaml", own)
                          for scenario in SCENARIOS}
    refresh(page, figures, runs)
    print(f"arms: {page}")


if __name__ == "__main__":
    main()
