"""What `hapticgiant identify` has found: tables, and lines for the files of the device."""

import math
import sys

LONGEST = 60  # characters of a combination of parameters
SURE = 2  # deviations: half of the interval that covers the truth with 95 %
SAID = "+- is the 95 % interval"


def unusable(why):
    print(f"not usable: {why}", file=sys.stderr)
    return 2


def half_interval(figure):
    return SURE * figure["deviation"]


def texts(figure, deviations):
    return f"{figure['value']:.3g}", f"+- {deviations * figure['deviation']:.3g}"


def cells(figure, deviations):
    value, interval = texts(figure, deviations) if figure["is_found"] else ("-", "")
    return f"{value:>9} {interval:<12}"


def print_yaml(indent, key, figure, deviations):
    print(f"{indent}{key}: {'  # '.join(texts(figure, deviations))}")


def figures_of(it):
    return {key: figure for key, figure in it.items() if isinstance(figure, dict)}


def print_missing(joint):
    for what in joint["missing"]:
        print(f"  not found: {what}")


# friction

def friction_yaml(joints):
    print("\nfor device.yaml, into the entry of each joint:\nactuators:")
    for joint in joints:
        print(f"  {joint['name']}:")
        if not joint["coulomb_friction_Nm"]["is_found"]:
            print("    # nothing was found")
        for key, it in figures_of(joint).items():
            if it["is_found"]:
                print_yaml("    ", key, it, 1)
        if "presliding_elements" in joint:
            print(f"    presliding_elements: {joint['presliding_elements']}")


def friction(results):
    joints = results["joints"]
    print(f"{results['file']}: {len(joints)} joints, drives on for {results['used_s']:.1f} s")
    for joint in joints:
        print(f"\n{joint['name']}  slid {joint['forward_s']:.0f} s forward, "
              f"{joint['backward_s']:.0f} s backward, {joint['reversals']} reversals, "
              f"up to {joint['speed_rad_per_s']:.2f} rad/s; "
              f"{joint['residual_Nm']:.2f} Nm rms unexplained")
        for key, it in figures_of(joint).items():
            print(f"  {key:<30}{cells(it, 1)}  device file {it['device_file']:.3g}")
        print_missing(joint)
    if not any(joint["coulomb_friction_Nm"]["is_found"] for joint in joints):
        return unusable("no joint moved enough for its friction")
    friction_yaml(joints)
    return 0


# stiffness, damping and delay of joints

ELASTICITY = ("stiffness_Nm_per_rad", "damping_Nms_per_rad")


def print_elasticity(joint):
    print(f"\n{joint['name']}  torque {joint['torque_Nm']:.3g} Nm rms, "
          f"twist {joint['twist_rad']:.2g} rad rms, "
          f"{joint['unexplained_twist_rad']:.1g} rad rms unexplained")
    for key in ELASTICITY:
        it = joint[key]
        in_files = f"{it['files']:.3g}" if it["files"] > 0.0 else "-"
        print(f"  {key:<24}{cells(it, SURE)}  files {in_files}")


def ms_text(figure):
    return f"{1e3 * figure['value']:>7.2f} ms +- {1e3 * half_interval(figure):.2f}"


def print_delay(joint):
    print(f"\n{joint['name']}  commanded {joint['commanded_rad_per_s']:.2g} rad/s rms, "
          f"{joint['unexplained_rad']:.1g} rad rms unexplained")
    delay, lag = joint["delay_s"], joint["lag_s"]
    if delay["is_found"]:
        print(f"  from command to position {ms_text(delay)}\n  of that, first-order lag "
              + (ms_text(lag) if lag["is_found"]
                 else f"      - (less than {1e3 * lag['less_than']:.1f} ms)"))


def actuators(joints, indent):
    print(f"{indent}actuators:")
    for joint in joints:
        found = {key: joint[key] for key in ELASTICITY if joint[key]["is_found"]}
        if found:
            print(f"{indent}  {joint['name']}:")
        for key, it in found.items():
            print_yaml(f"{indent}    ", key, it, SURE)


def joints_yaml(results, has_both_sides):
    latency = results.get("latency_s")
    print("\nfor the simulation file:\ndrives:" if latency else
          "\nfor device.yaml, into the entry of each joint (and 'stiffness: 1', 'damping: 1' under "
          "'factors' of the simulation file):")
    if latency and latency["is_found"]:
        print(f"  latency_s: {latency['value']:.5f}  # +- {half_interval(latency):.5f}, file "
              f"{latency['files']:.5f}")
    if has_both_sides:
        actuators(results["joints"], "  " if latency else "")


def joints(results):
    moved = results["joints"]
    has_both_sides = all(ELASTICITY[0] in joint for joint in moved)
    print(f"{results['file']}: {len(moved)} joints, drives on for {results['used_s']:.1f} s; "
          f"{SAID}")
    if not has_both_sides:
        print("stiffness and damping: not in this recording, the device does not report motors, "
              "joints and joint torques")
    for joint in moved:
        if has_both_sides:
            print_elasticity(joint)
        if "delay_s" in joint:
            print_delay(joint)
        print_missing(joint)
    has_stiffness = has_both_sides and any(joint[ELASTICITY[0]]["is_found"] for joint in moved)
    if not has_stiffness and not results.get("delay_s", {}).get("is_found"):
        return unusable("no joint moved enough for its stiffness or delay")
    joints_yaml(results, has_both_sides)
    return 0


# inertial parameters

MOSTLY = "  mostly the URDF's"
AXES = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")  # as a URDF has them


def shortened(name):
    return name if len(name) <= LONGEST else f"{name[:LONGEST]} ..."


def inertia_row(figure):
    return f"{figure['urdf']:>10.4f} {figure['value']:>10.4f} {half_interval(figure):>9.4f}"


def print_urdf(links):
    print("\nfor the URDF, all of them together:")
    for link in links:
        value = {key: f"{it['value']:.6g}" for key, it in figures_of(link).items()}
        about_com = " ".join(f'{axes}="{value[f"{axes}_kg_m2"]}"' for axes in AXES)
        print(f"<!-- {link['name']} -->\n<inertial>\n"
              f'  <origin xyz="{value["com_x_m"]} {value["com_y_m"]} {value["com_z_m"]}" '
              'rpy="0 0 0"/>\n'
              f'  <mass value="{value["mass_kg"]}"/>\n  <inertia {about_com}/>\n</inertial>')


def inertia(results):
    print(f"{results['file']}: drives on for {results['used_s']:.1f} s; {SAID}")
    for joint in results["joints"]:
        print(f"{joint['name']:<22} moved over {joint['way_rad']:.2f} rad, "
              f"{joint['acceleration_rad_per_s2']:.2g} rad/s^2 rms; {joint['unexplained_Nm']:.3g} "
              f"Nm rms unexplained, {joint['unexplained_by_files_Nm']:.3g} by the files")
    if results["missing"]:
        return unusable(results["missing"])
    head, base = f"{'URDF':>10} {'found':>10} {'+-':>9}", results["base"]
    print(f"\n{sum(it['is_found'] for it in base)} of {len(base)} base parameters show "
          f"(kg, kg m, kg m^2):\n{head}")
    for it in base:
        print(f"{inertia_row(it)}  {shortened(it['name'])}{'' if it['is_found'] else '  (open)'}")
    for link in results["links"]:
        print(f"\n{link['name']:<14}{head}")
        for key, it in figures_of(link).items():
            print(f"  {key:<12}{inertia_row(it)}{'' if it['is_found'] else MOSTLY}")
    print_urdf(results["links"])
    return 0


# payload

def row(values, digits):
    return ", ".join(f"{value:.{digits}f}" for value in values)


def number(value, digits):
    """JSON has no infinity: what the poses do not show."""
    return f"{math.inf if value is None else value:.{digits}f}"


def payload(results):
    mass, com, offset = results["mass_kg"], results["com_m"], results["offset"]
    source = (f"from {', '.join(results['files'])}" if results["files"]
              else f"of the simulated {results['device']}, handle not held")
    print(f"{results['poses']} poses {source}\n\n"
          f"mass            {mass:.4f} kg, +-{number(results['mass_deviation_kg'], 4)}\n"
          f"centre of mass  {row(com, 4)} m in S, +-{number(results['com_deviation_m'], 4)}\n"
          f"sensor offset   {row(offset[:3], 2)} N; {row(offset[3:], 4)} Nm\n"
          f"residuals       {results['residual_N']:.3f} N, {results['residual_Nm']:.4f} Nm rms\n"
          f"condition       {number(results['condition'], 1)}  (1 = every direction shows alike)")
    if drawn := results.get("device_file"):
        print(f"device.yaml     mass {100.0 * (mass / drawn['mass_kg'] - 1.0):+.2f} %, "
              f"centre of mass {1e3 * math.dist(com, drawn['com_m']):.1f} mm from its values")
    for doubt in results["doubts"]:
        print(f"WARNING {doubt}", file=sys.stderr)
    if results["missing"]:
        return unusable(results["missing"])
    print(f"\nfor device.yaml:\npayload:\n  mass_kg: {mass:.4f}\n"
          f"  centre_of_mass_m: [{row(com, 4)}]\n"
          "  # inertia_kg_m2 does not show at rest: from the drawing")
    return 0


IDENTIFIED = {"friction": friction, "joints": joints, "inertia": inertia, "payload": payload}


def write(results, folder, docs=None):
    """Prints only; returns 2 where the motion or the poses do not suffice."""
    del folder, docs
    print(results.get("losses", ""), end="")
    return IDENTIFIED[results["identified"]](results)
