"""report.html of `hapticgiant design`: front, convergence, coverage maps, sensitivity."""


import matplotlib
import numpy as np

from ..figures import SETTINGS
from . import pictures
from .pages import render, save

BURDENS = {"moving_mass_kg": ("moving mass", "kg"), "price": ("price", "")}
TERMS = {"pose": "poses", "velocity": "speed", "turn_velocity": "speed of turning",
         "acceleration": "acceleration", "turn_acceleration": "acceleration of turning",
         "force": "force", "torque": "torque", "walk": "room to walk"}
LENGTHS = ("L1", "L2", "D3", "L4", "D6", "gantry_x", "gantry_y", "mount_height")
COLOURS = {"sga": "#1f77b4", "gaco": "#ff7f0e"}
CELL = 0.1  # m, of the maps
CHOSEN, BASE = "#d62728", "#555555"


def draw_front(panel, results):
    key = results["burden"]
    name, unit = BURDENS[key]
    front = [point["score"] for point in results["front"]]
    panel.plot([it[key] for it in front], [it["capability"] for it in front], "o", markersize=3.5,
               color="#1f77b4", label="front")
    for who, colour, marker in (("chosen", CHOSEN, "*"), ("base", BASE, "s")):
        score = results[who]["score"]
        label = results["name"] if who == "chosen" else results["base"]["name"]
        panel.plot(score[key], score["capability"], marker, markersize=9 if marker == "*" else 6,
                   color=colour, label=label)
    panel.set_xlabel(f"{name}, {unit}" if unit else name)
    panel.set_ylabel("capability")
    panel.legend(fontsize=7)


def draw_convergence(panel, results):
    islands = {}
    for row in results["convergence"]:
        islands.setdefault((row["island"], row["algorithm"]), []).append(row)
    named = set()
    for (_, algorithm), rows in sorted(islands.items()):
        panel.plot([it["evaluations"] for it in rows], [max(it["value"], 0.0) for it in rows],
                   color=COLOURS[algorithm], linewidth=1.0,
                   label=None if algorithm in named else algorithm)
        named.add(algorithm)
    panel.set_xlabel("candidates, per island")
    panel.set_ylabel("capability less penalties")
    panel.legend(fontsize=7)


def share_per_cell(rows, right, up):
    """Share of the poses per cell that are reached; NaN without any."""
    rows = np.array(rows, dtype=float)
    low = np.floor(rows[:, [right, up]].min(axis=0) / CELL) * CELL
    index = np.floor((rows[:, [right, up]] - low) / CELL + 1e-9).astype(int)
    counts = index.max(axis=0) + 1
    every, reached = np.zeros(counts[::-1]), np.zeros(counts[::-1])
    np.add.at(every, (index[:, 1], index[:, 0]), rows[:, 3])
    np.add.at(reached, (index[:, 1], index[:, 0]), rows[:, 3] * rows[:, 4])
    with np.errstate(invalid="ignore"):
        share = reached / every
    return share, low[0] + CELL * np.arange(counts[0] + 1), low[1] + CELL * np.arange(counts[1] + 1)


def draw_map(panel, rows, title):
    share, x, z = share_per_cell(rows, 0, 2)
    mesh = panel.pcolormesh(x, z, share, vmin=0.0, vmax=1.0, cmap="viridis")
    panel.set_aspect("equal")
    panel.set_title(title, fontsize=8)
    panel.set_xlabel("forward of the person, m")
    panel.set_ylabel("height, m")
    return mesh


def figure_of(results):
    figure = pictures.new_figure(6.2)
    panels = figure.subplots(2, 2)
    draw_front(panels[0, 0], results)
    draw_convergence(panels[0, 1], results)
    draw_map(panels[1, 0], results["coverage"]["base"], f"{results['base']['name']}: poses reached")
    mesh = draw_map(panels[1, 1], results["coverage"]["chosen"], f"{results['name']}: poses reached")
    figure.colorbar(mesh, ax=list(panels[1]), label="share")
    return figure


def variable_rows(results):
    chosen, base = results["chosen"]["variables"], results["base"]["variables"]
    rows = [["", results["name"], results["base"]["name"]]]
    rows += [[f"{name}, m", f"{chosen[name]:.3f}", f"{base[name]:.3f}"] for name in LENGTHS]
    rows += [[f"joint {new['name']}", f"{new['size']}, 1:{new['ratio']:g}",
              f"{old['size']}, 1:{old['ratio']:g}"]
             for new, old in zip(chosen["joints"], base["joints"])]
    return rows


def score_rows(results):
    new, old = results["chosen"]["score"], results["base"]["score"]
    rows = [["", results["name"], results["base"]["name"]],
            ["capability", f"{new['capability']:.3f}", f"{old['capability']:.3f}"]]
    rows += [[f"  {text}", f"{new['terms'][key]:.3f}", f"{old['terms'][key]:.3f}"]
             for key, text in TERMS.items()]
    for key, text, digits in (("moving_mass_kg", "moving mass, kg", 1), ("price", "price", 0),
                              ("force_N", "force in 95 % of the poses, N", 0),
                              ("torque_Nm", "torque in 95 % of the poses, Nm", 1),
                              ("clear_share", "poses clear of the person, share", 2),
                              ("share_regular", "without singularity, share", 2),
                              ("reflected_mass_mean_kg", "felt mass, mean, kg", 1),
                              ("eigenfrequency_free_Hz", "first mode, handle free, Hz", 1),
                              ("eigenfrequency_clamped_Hz", "first mode, links held, Hz", 1)):
        rows.append([text, f"{new[key]:.{digits}f}", f"{old[key]:.{digits}f}"])
    return rows


def sensitivity_rows(results):
    rows = [["variable", "change", "capability", "moving mass, kg", "price", "requirements"]]
    for it in results["sensitivity"]:
        if "fault" in it:
            rows.append([it["variable"], it["change"], "no device", "", "", it["fault"]])
            continue
        broken = "broken" if it["violation"] > 1e-6 else "met"
        rows.append([it["variable"], it["change"], f"{it['capability']:+.4f}",
                     f"{it['moving_mass_kg']:+.2f}", f"{it['price']:+.0f}", broken])
    return rows


def against_front(results):
    """Whether the base lies on the front, and why not."""
    base, facts = results["base"], results["base"]["against_front"]
    name = BURDENS[results["burden"]][0]
    if facts["is_near"]:
        return True, f"{base['name']} lies on or near the front."
    terms = sorted(facts["by_term"].items(), key=lambda item: -abs(item[1]))[:3]
    why = ", ".join(f"{TERMS[key]} {value:+.3f}" for key, value in terms)
    return False, (f"{base['name']} does not lie on the front: a design of no more {name} has "
                   f"{facts['capability_ahead']:.3f} more capability, of which {why}.")


def verdicts(results):
    broken = results["chosen"]["score"]["violation"] > 0.0
    rows = [(not broken, "No candidate meets all requirements." if broken
             else "The design meets all requirements."), against_front(results)]
    for key, text in (("check", "`hapticgiant check` of the device"), ("door", "The door"),
                      ("haptify", "The Haptify table")):
        if key in results.get("feel", {}):
            is_good = results["feel"][key]
            rows.append((is_good, f"{text}: {'passed' if is_good else 'failed'}, see {key}.txt."))
    return rows


def write(results, folder, docs=None):
    del docs
    with matplotlib.rc_context(SETTINGS):
        svg = pictures.to_svg(figure_of(results), "design")
    save(folder / "figure.svg", svg)
    command = f"hapticgiant design {results['problem']} --seed {results['seed']}"
    page = render(
        "page.html.jinja", title=results["name"],
        source=f"{results['islands']} islands of {results['population']}, {results['generations']} "
               f"generations, {results['poses']} poses of the hand, seed {results['seed']}, "
               f"{results['seconds']:.0f} s; found by {results['found_by']}",
        about="A device for the arm of a standing person. Capability is the weighted mean of the terms "
              "below, each from 0 to 1. Masses and prices of the catalogue are assumed.",
        verdicts=verdicts(results), figure=svg,
        caption="Front of designs that no other beats, how the search converged, and the share of the "
                "hand's poses that are reached, seen from the side.",
        sections=[{"title": "Variables", "rows": variable_rows(results)},
                  {"title": "What it can do", "rows": score_rows(results)},
                  {"title": "What a percent costs", "rows": sensitivity_rows(results),
                   "note": "One percent of each length, one step of each size or ratio; all else stays."}],
        command=command, version=results.get("version", ""), files="results.json, figure.svg, device/")
    save(folder / "report.html", page)
    return 0
