"""What `hapticgiant experiment contact|free-space|impedance|inertial|seeds|stability-map` shows: series of runs."""

import itertools
import statistics

import matplotlib
import numpy as np

from ..figures import SETTINGS
from . import pages, pictures, tables
from .measured import NOT_POSSIBLE


def middle(values):
    """The median; of an even number the upper one, which was played."""
    return statistics.median_high(values)


# contact with a bystander

CONTACT_HEAD = ["by", "on", "m/s", "N off", "N on", "allowed", "N/cm^2", "Ns", "ms", "later N off",
                "later N on", "allowed", "reported ms", "stop ms"]


def is_too_much(case, run):
    return (run["max_force_N"] > case["permissible_transient_N"]
            or run["settled_force_N"] > case["permissible_quasi_static_N"]
            or run["max_pressure_N_per_cm2"] > case["permissible_pressure_N_per_cm2"])


def contact_row(case):
    off, on = case["without"], case["with"]
    transient, settled = case["permissible_transient_N"], case["permissible_quasi_static_N"]

    def force(value, most):
        return f"{value:.0f}{'!' if value > most else ''}"

    def both(key, digits, scale=1.0):
        return f"{scale * off[key]:.{digits}f} / {scale * on[key]:.{digits}f}"

    def time(run, key):
        return f"{1e3 * run[key]:.0f}" if key in run else "-"

    return [case["hit_by"],
            case["body_part"].replace("_", " ") + (", clamped" if case["is_clamped"] else ""),
            f"{case['speed_m_per_s']:g}", force(off["max_force_N"], transient),
            force(on["max_force_N"], transient), f"{transient:.0f}",
            both("max_pressure_N_per_cm2", 0), both("impulse_Ns", 1), both("contact_s", 0, 1e3),
            force(off["settled_force_N"], settled), force(on["settled_force_N"], settled),
            f"{settled:.0f}", time(on, "reported_s"), f"{time(off, 'stopped_s')} / {time(on, 'stopped_s')}"]


def contact_figure(results):
    """Forces over their permissible values, a panel per speed."""
    cases = results["cases"]
    speeds = sorted({case["speed_m_per_s"] for case in cases})
    names = list(dict.fromkeys(", ".join(contact_row(case)[:2]) for case in cases))
    figure = pictures.new_figure(0.8 + 0.19 * len(names))
    panels = figure.subplots(1, len(speeds), sharey=True, squeeze=False)[0]
    kinds = (("max_force_N", "permissible_transient_N", "largest force", pictures.COLOURS[0], -0.12),
             ("settled_force_N", "permissible_quasi_static_N",
              f"force after {results['settled_s']:g} s", pictures.COLOURS[1], 0.12))
    for panel, speed in zip(panels, speeds):
        chosen = [case for case in cases if case["speed_m_per_s"] == speed]
        places = [names.index(", ".join(contact_row(case)[:2])) for case in chosen]
        for key, most, name, colour, offset in kinds:
            for side, fill in (("without", "none"), ("with", "full")):
                panel.plot([case[side][key] / case[most] for case in chosen],
                           [place + offset for place in places], "o", color=colour, markersize=3.5,
                           fillstyle=fill, label=f"{name}, {side} compliance")
        panel.axvline(1.0, color="black", linewidth=0.8, label="permissible")
        panel.set_xscale("symlog", linthresh=1.0)
        panel.set_xticks([0, 1, 10, 100], ["0", "1", "10", "100"])
        panel.set(xlabel="force over permissible", xlim=(-0.05, None),
                  ylim=(len(names) - 0.4, -0.6))
        panel.set_title(f"{speed:g} m/s")
    panels[0].set_yticks(range(len(names)), names)
    pictures.legend_of(figure, panels[0])
    return figure


def contact(folder, results, docs):
    cases = results["cases"]
    rows = [CONTACT_HEAD, *map(contact_row, cases)]
    without, with_it = (sum(is_too_much(case, case[key]) for case in cases)
                        for key in ("without", "with"))
    verdict = ("! above the permissible value of ISO/TS 15066. Cases above one of them: "
               f"{without} of {len(cases)} without compliance, {with_it} with it.\n")
    seeds = f"orst of seeds 1 to {results['seeds']}"
    print(f"{tables.as_text(rows, left=range(2))}\nw{seeds}; off / on: without and with compliance\n{verdict}",
          end="")
    if docs:
        with matplotlib.rc_context(SETTINGS):
            svg = pictures.to_svg(contact_figure(results), "contact")
        page = docs / "contact.md"
        pages.refresh(page, f"{pages.PageTables(page)(rows, 'cases')}\nW{seeds}. {verdict}", svg)
    return 0


# inertial units

INERTIAL_HEAD = [["scenario", "units", "from", "joints", "joints", "gantry", "handle", "handle", "late",
                  "bump"],
                 ["", "", "", "mrad/s", "rad/s^2", "m/s^2", "mm/s", "m/s^2", "ms", "rad/s^2"]]
ERRORS = (("joint_speed", 1e3, 2), ("joint_acceleration", 1.0, 3), ("gantry_acceleration", 1.0, 3),
          ("handle_speed", 1e3, 2), ("handle_acceleration", 1.0, 3))


def inertial_rows(runs):
    rows, seen = [], set()
    for (scenario, units), group in itertools.groupby(runs, lambda run: (run["scenario"],
                                                                         run["units"])):
        same = list(group)

        def line(name, source, key, *more):
            rows.append([scenario, name, source] + [
                f"{scale * middle([run[key][part] for run in same]):.{digits}f}"
                for part, scale, digits in ERRORS] + list(more or ("", "")))

        if scenario not in seen:
            line("-", "encoders, reference", "reference")
            line("-", "encoders, differences", "encoders")
        seen.add(scenario)
        line(units, "encoders and units", "inertial",
             f"{1e3 * middle([run['lateness_s'] for run in same]):.1f}",
             f"{middle([run['largest_change'] for run in same]):.1f}")
    return rows


FELT_HEAD = [["what a hand feels", "transparency", "latency", "extra", "vibration", "centroid", "joints",
              "0.3 kg", "0.4 kg", "wall of 20 kN/m"],
             ["", "Hz", "ms", "N", "m/s^2", "Hz", "mrad", "mm/s", "mm/s", "6 kg, 3 kg"]]
FELT = (("transparency_Hz", 1.0, 1), ("latency_s", 1e3, 1), ("extra_N", 1.0, 2),
        ("vibration_m_per_s2", 1.0, 3), ("centroid_Hz", 1.0, 0), ("joint_error_rad", 1e3, 2),
        ("light_normal_m_per_s", 1e3, 1), ("light_stiff_m_per_s", 1e3, 1))


def felt_rows(felt):
    return [[name, *(f"{scale * figures[key]:.{digits}f}" for key, scale, digits in FELT),
             ", ".join(figures["wall"])] for name, figures in felt.items()]


def inertial(folder, results, docs):
    print(tables.as_text(INERTIAL_HEAD + inertial_rows(results["runs"]), left=range(3)), end="")
    for run in results["runs"]:
        if run["fault"]:
            print(f"{run['scenario']}, {run['units']}, seed {run['seed']}: fault {run['fault']} "
                  f"{run['fault_text']}")
    if "felt" in results:
        print("\n" + tables.as_text(FELT_HEAD + felt_rows(results["felt"]), left=(0, 9)), end="")
    return 0


# free space with parts of the machine changed

FREE_SPACE_HEAD = [["", "force", "own", "extra", "vibration", "centre", "> 5 Hz", "joints", "torque", ""],
                   ["variant", "N", "N", "N", "m/s^2", "Hz", "m/s^2", "mrad", "of peak", ""]]
FREE_SPACE = (("force_N", 2), ("own_share_N", 2), ("extra_N", 2), ("vibration_m_per_s2", 3),
              ("centroid_Hz", 0), ("acceleration_above_5_Hz_m_per_s2", 3))


def failure_of(run):
    why = run.get("failure", "")
    return f"failed: {why}" if why and not why.startswith(NOT_POSSIBLE) else why


def free_space_row(variant):
    why = failure_of(variant)
    if why.startswith(NOT_POSSIBLE):
        return [variant["name"], *["-"] * (len(FREE_SPACE) + 2), why]
    return [variant["name"],
            *(f"{variant['measured'][key]:.{digits}f}" for key, digits in FREE_SPACE),
            f"{1e3 * variant['joint_error_rad']:.2f}", f"{variant['torque_share']:.2f}",
            failure_of(variant)]


def dominant(variants, key):
    """The imperfection whose removal improves a value most; None = no removal improves it."""
    removed = [variant for variant in variants if variant["takes_away"] and "failure" not in variant]
    best = min(removed, key=lambda variant: variant["measured"][key], default=variants[0])
    return best if best["measured"][key] < variants[0]["measured"][key] else None


def dominant_line(variants, what, key, unit):
    best = dominant(variants, key)
    if best is None:
        return f"{what:<20} no removal makes it smaller\n"
    return (f"{what:<20} most by '{best['name']}': {best['measured'][key]:.3f} instead of "
            f"{variants[0]['measured'][key]:.3f} {unit}\n")


def free_space(folder, results, docs):
    variants = results["variants"]
    print(tables.as_text(FREE_SPACE_HEAD + list(map(free_space_row, variants)), left=(0, 9))
          + "\nown: mean |m a + b v| of the twin; extra: mean |f - (m a + b v)|; both of the true handle, "
          f"below {results['force_below_Hz']:g} Hz\nvibration: rms above "
          f"{results['vibration_above_Hz']:g} Hz, as in `hapticgiant haptify`\n\n"
          + dominant_line(variants, "extra force", "extra_N", "N")
          + dominant_line(variants, "vibration", "vibration_m_per_s2", "m/s^2")
          + dominant_line(variants, "above 5 Hz", "acceleration_above_5_Hz_m_per_s2", "m/s^2"), end="")
    return 0


# impedance at the handle

def mobility(run):
    """Velocity over force at the run's frequencies, m/Ns."""
    return np.array([complex(*pair) for pair in run["mobility_m_per_Ns"]])


def compliance(run):
    """Deflection over force at the run's frequencies, m/N."""
    return np.abs(mobility(run)) / (2.0 * np.pi * np.array(run["frequency_Hz"]))


def felt_share(run, twin):
    """Felt impedance over that of the twin, j w m + b, at the run's frequencies."""
    omega = 2.0 * np.pi * np.array(run["frequency_Hz"])
    return np.abs(1.0 / (mobility(run) * (1j * omega * twin["mass_kg"] + twin["damping_Ns_per_m"])))


def impedance_table(runs, title, columns, row):
    """`row` gives the columns of a run behind its name."""
    longest = max(runs, key=lambda run: len(run["frequency_Hz"]))
    head = [title, *(f"{frequency:g} Hz" for frequency in longest["frequency_Hz"]), *columns]
    rows = [[f"{run['name']}, along {run['axis']}", *row(run)] for run in runs]
    width = max(map(len, [head, *rows]))
    return tables.as_text([cells + [""] * (width - len(cells)) for cells in [head, *rows]])


def impedance(folder, results, docs):
    rigid = [run for run in results["runs"] if run["is_rigid"]]
    moved = [run for run in results["runs"] if not run["is_rigid"]]
    twin = results["twin"]

    def given(run):
        still = [f"{1e3 * run[key]:.2f} mm" if key in run else "-"
                 for key in ("static_peak_m", "static_end_m")]
        return [*(f"{1e6 * value:.1f}" for value in compliance(run)), *still, failure_of(run)]

    def felt(run):
        return [*(f"{share:.2f}" for share in felt_share(run, twin)), failure_of(run)]

    print(impedance_table(rigid, "twin does not move: um per N",
                          [f"{results['static_force_N']:g} N: peak",
                           f"after {results['static_end_s']:g} s"], given)
          + "blind: the force/torque sensor shows nothing, so nothing is fed forward\n\n"
          + impedance_table(moved, f"twin of {twin['mass_kg']:g} kg, {twin['damping_Ns_per_m']:g} Ns/m: "
                            "felt / rendered", [], felt), end="")
    return 0


# many seeds

SEEDS_HEAD = ["scenario", "hand", "held", "events", "outside mrad", "worst at", "outside mm",
              "worst at", "joints mrad", "handle mm", "torque %", "vibration m/s^2"]


def trials_of(runs):
    """Runs of each scenario with a hand, in their order."""
    return [list(group) for _, group in itertools.groupby(runs, lambda run: run["trial"])]


def hand_of(run):
    return run["hand"] or "its own"


def seeds_row(runs):
    def share(count):
        return f"{count} of {len(runs)}"

    def spread(values, digits):
        return f"{middle(values):.{digits}f} / {max(values):.{digits}f}"

    def outside(key):
        worst = max(runs, key=lambda run: run[key]["excess"])[key]
        return [spread([1e3 * run[key]["excess"] for run in runs], 2), worst["limit"] or "-"]

    def scaled(key, digits, scale):
        return spread([scale * run[key] for run in runs], digits)

    first = runs[0]
    return [first["scenario"], hand_of(first), share(sum(run["held"] for run in runs)),
            share(sum(run["missing_events"] == 0 for run in runs)) if first["expected_events"] else "-",
            *outside("angle_rad"), *outside("length_m"), scaled("joint_error_rad", 2, 1e3),
            scaled("handle_distance_m", 2, 1e3), scaled("torque_share", 0, 100.0),
            scaled("vibration_m_per_s2", 3, 1.0)]


def fault_lines(trials):
    for runs in trials:
        for code in sorted({run["fault"] for run in runs} - {0}):
            found = [run for run in runs if run["fault"] == code]
            first = found[0]
            yield (f"- {first['scenario']}, {hand_of(first)} hand: {code} {first['fault_text']} in "
                   f"{len(found)} runs, first at {first['ended_s']:.2f} s with seed {first['seed']}\n")


def seeds(folder, results, docs):
    trials = trials_of(results["runs"])
    rows = [SEEDS_HEAD, *map(seeds_row, trials)]
    faults = "".join(fault_lines(trials))
    print(f"{tables.as_text(rows, left=range(len(SEEDS_HEAD)))}\nmedian / worst over the seeds; held: no "
          f"fault, and no limit left by more than 2 mrad or 1 mm in truth\n{faults}", end="")
    pages.save(folder / "seeds.md", "# What scenarios show over seeds\n\n" + tables.markdown(rows)
               + (f"\n{faults}" if faults else ""))
    return 0 if all(run["held"] for run in results["runs"]) else 1


# stability map

def letter(verdict):
    return pictures.VERDICTS[verdict][1]


def mass_text(results, row):
    mass = row["stable_from_kg"]
    if mass is None:
        return "none"
    return f"<= {mass:g}" if mass <= results["least_mass_kg"] else f"{mass:.2f}"


def by_damping(results):
    for damping, rows in itertools.groupby(results["rows"], lambda row: row["damping_Ns_per_m"]):
        yield damping, list(rows)


def verdicts_of(rows):
    return [[cell["verdict"] for cell in row["cells"]] for row in rows]


def stability_text(results):
    parts = []
    masses = [f"{mass:g}" for mass in results["mass_kg"]]
    for damping, rows in by_damping(results):
        lines = [["hand", *masses, "  kg   stable from, kg"]] + [
            [row["hand"], *map(letter, verdicts), "       " + mass_text(results, row)]
            for row, verdicts in zip(rows, verdicts_of(rows))]
        parts.append(f"twin with {damping:g} Ns/m\n" + "".join(
            f"{line[0]:<10}" + "".join(f"{cell:>5}" for cell in line[1:-1]) + line[-1] + "\n"
            for line in lines))
    cells = [verdict for row in verdicts_of(results["rows"]) for verdict in row]
    unstable = cells.count("sustained") + cells.count("diverges")
    return "\n".join(parts) + (
        f"\n{cells.count('hunts')} of {len(cells)} cells hunt (h), {unstable} swing or diverge without "
        f"end (U, X)\n\n.  stable        r  calms down, but not within {results['watched_s']:g} s"
        f"        X  diverges\nU  sustained, above {1e3 * results['calm_m_per_s']:g} mm/s        h  the "
        "same, but not without friction: the joints stick and slip, not stable either\n")


def stability_figure(results):
    """A map per damping of the twin; beside each row the smallest stable mass."""
    maps = list(by_damping(results))
    figure = pictures.new_figure(1.5 + 0.24 * max(len(rows) for _, rows in maps))
    panels = figure.subplots(1, len(maps), squeeze=False)[0]
    masses = [f"{mass:g}" for mass in results["mass_kg"]]
    for panel, (damping, rows) in zip(panels, maps):
        pictures.draw_map(panel, [row["hand"] for row in rows], masses, verdicts_of(rows), "",
                          "rendered mass in kg")
        panel.set_title(f"twin with {damping:g} Ns/m", loc="left")
        panel.set_title("from, kg", loc="right")
        from_kg = panel.secondary_yaxis("right")
        from_kg.set_yticks(range(len(rows)), [mass_text(results, row) for row in rows])
        from_kg.tick_params(length=0)
    figure.suptitle(
        f"Where contact becomes unstable: simulated {results['device']}\n"
        f"A free body is held by a mass of {results['arm_kg']:g} kg on a spring (or by a person) and "
        f"kicked with {results['kick_N']:g} N for {1e3 * results['kick_s']:g} ms", fontsize=8)
    pictures.verdict_legend(figure, verdicts_of(results["rows"]))
    return figure


def stability_map(folder, results, docs):
    print(stability_text(results), end="")
    with matplotlib.rc_context(SETTINGS):
        pages.save(folder / "map.svg", pictures.to_svg(stability_figure(results), "map"))
    return 0


SERIES = {"contact": contact, "free-space": free_space, "impedance": impedance, "inertial": inertial,
          "seeds": seeds, "stability-map": stability_map}


def write(results, folder, docs=None):
    return SERIES[results["kind"]](folder, results, docs)
