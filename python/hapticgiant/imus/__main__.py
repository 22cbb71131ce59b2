"""Command line of `hapticgiant imus`; docs/start/imu_placement.md.

Exit codes: 0 placed, 2 bad input, 130 ended by Ctrl-C.
"""

from __future__ import annotations

import argparse
import json
import math
import pathlib
import sys

if not __package__:
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
    import as_folder  # noqa: F401

RANDOM = 32  # placements that a choice is compared with
LEAST_S = 0.1  # of a motion


def positive(text):
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not (math.isfinite(number) and number > 0):
        raise argparse.ArgumentTypeError(f"expected a number above 0, got '{text}'")
    return number


def place_of(text):
    link, _, words = text.rpartition(":")
    try:
        numbers = tuple(float(word) for word in words.split(","))
    except ValueError:
        numbers = ()
    if not link or len(numbers) != 3 or not all(map(math.isfinite, numbers)):
        raise argparse.ArgumentTypeError(f"expected LINK:X,Y,Z in m, got '{text}'")
    return link, numbers


def parser():
    from hapticgiant.command_line import Parser, whole_number

    found = Parser(
        prog="hapticgiant imus", description="Where inertial sensors observe best the speeds and "
        "accelerations of the joints of a robot (docs/start/imu_placement.md).")
    add = found.add_argument
    add("robot", metavar="URDF_OR_DEVICE", help="a URDF, or a device.yaml")
    add("--count", type=whole_number(1), default=1, metavar="N", help="sensors; default: 1")
    add("--measure", choices=("covariance", "gramian"), default="covariance",
        help="error covariance of a Kalman filter (default), or observability Gramian")
    add("--criterion", choices=("logdet", "lambda_min", "trace"), default="logdet",
        help="all states together (default), the worst direction, or the mean square")
    add("--exhaustive", type=whole_number(1), default=600, metavar="N",
        help="tries every placement where there are at most N of them; default: 600")
    group = found.add_argument_group("motion")
    add = group.add_argument
    add("--seed", type=whole_number(0), default=1, help="of the sums of sines; default: 1")
    add("--duration", type=positive, default=2.0, metavar="S", help="default: 2")
    add("--motion", metavar="CSV", help="positions instead of sines: time_s, a column per joint, or a "
        "table of hapticgiant export")
    group = found.add_argument_group("candidates")
    add = group.add_argument
    add("--grid", type=whole_number(1), default=2, metavar="N",
        help="points along each edge of a link's box; default: 2")
    add("--link", action="append", metavar="LINK", help="only on this link; may be given several times")
    add("--one-per-link", action="store_true", help="no link carries two sensors")
    add("--at", type=place_of, action="append", metavar="LINK:X,Y,Z",
        help="a place of your own, m in the link's frame, instead of the grid; several times")
    add("--no-gravity", action="store_true", help="accelerometers do not feel gravity")
    group = found.add_argument_group("sensors")
    add = group.add_argument
    add("--rate", type=positive, default=1000.0, metavar="HZ", help="samples; default: 1000")
    add("--gyro", type=positive, default=2.4e-4, metavar="NOISE",
        help="rad/s/sqrt(Hz); default: %(default)s")
    add("--accelerometer", type=positive, default=1.7e-3, metavar="NOISE",
        help="m/s^2/sqrt(Hz); default: %(default)s")
    add("--encoder", type=positive, default=2e-6, metavar="RAD", help="rms per sample; default: %(default)s")
    add("--encoder-slide", type=positive, default=3e-6, metavar="M",
        help="of sliding joints; default: %(default)s")
    add("--no-encoders", action="store_true")
    add("--jerk", type=positive, default=100.0, metavar="NOISE",
        help="white jerk of the joints, rad/s^3/sqrt(Hz); default: %(default)s")
    add("--jerk-slide", type=positive, default=20.0, metavar="NOISE",
        help="of sliding joints, m/s^3/sqrt(Hz); default: %(default)s")
    group = found.add_argument_group("output")
    group.add_argument("--json", metavar="FILE", help="everything, with positions, errors and options")
    group.add_argument("--picture", metavar="FILE", help="where they go and what they bring (svg, png, pdf)")
    return found


def suggestion(name, names):
    from hapticgiant.command_line import nearest

    return f"; did you mean '{nearest(name, names)}'?" if names else ""


def robot(file):
    """(chain, middle of the motion or None, columns of an export by joint) of a URDF or device."""
    import numpy as np

    from hapticgiant.imus.chain import Chain, InputError

    file = pathlib.Path(file)
    if file.suffix not in (".yaml", ".yml"):
        return Chain(file), None, {}
    import yaml
    try:
        device = yaml.safe_load(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{file}: {error.strerror}") from None
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        line = getattr(getattr(error, "problem_mark", None), "line", None)
        where = file if line is None else f"{file}:{line + 1}"
        raise InputError(f"{where}: no YAML: {getattr(error, 'problem', None) or error}") from None
    if not isinstance(device, dict) or not isinstance(device.get("urdf"), str):
        raise InputError(f"{file}: expected a device with the key 'urdf', or a URDF")
    chain = Chain(file.parent / device["urdf"])
    names = [joint.name for joint in chain.moving]

    def each(key):
        values = device.get(key) or {}
        if not isinstance(values, dict):
            raise InputError(f"{file}: {key}: expected a value per joint")
        for name in values:
            if name not in names:
                raise InputError(f"{file}: {key}: no joint '{name}'{suggestion(str(name), names)}")
        return values

    def number(value, where):
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise InputError(f"{file}: {where}: expected a number, got '{value}'")
        return float(value)

    middle = np.array([(joint.q_min + joint.q_max) / 2 for joint in chain.moving])
    for name, value in each("posture").items():
        middle[names.index(name)] = number(value, f"posture: {name}")
    for name, keys in each("joints").items():
        joint = chain.moving[names.index(name)]
        for key, value in (keys if isinstance(keys, dict) else {}).items():
            if key in ("q_min_rad", "q_min_m"):
                joint.q_min = number(value, f"joints: {name}: {key}")
            elif key in ("q_max_rad", "q_max_m"):
                joint.q_max = number(value, f"joints: {name}: {key}")
        if not joint.q_min < joint.q_max:
            raise InputError(f"{file}: joints: {name}: expected q_min < q_max, "
                             f"got {joint.q_min:g} and {joint.q_max:g}")
    columns = {}
    for key, column in (("gantry", "robot.q_p"), ("manipulator", "robot.q_m")):
        for index, name in enumerate(device.get(key) or []):
            columns[name] = f"{column}[{index}]"
    return chain, middle, columns


def places_of(chain, options):
    from hapticgiant.imus import placement
    from hapticgiant.imus.chain import InputError

    moving = chain.moving_links()
    for link in [*(options.link or []), *(link for link, _ in options.at or [])]:
        if link not in moving:
            raise InputError(f"{chain.file}: no moving link '{link}'{suggestion(link, moving)}")
    if options.at:
        return list(dict.fromkeys(placement.Candidate(*each) for each in options.at))
    return placement.candidates(chain, options.grid, options.link)


def describe(place):
    return f"{place.link} ({', '.join(f'{x:g}' for x in place.r)}) m"


def table(chain, errors, labels):
    n, width = chain.n, max(10, *(len(joint.name) for joint in chain.moving))
    for title, first, power in (("speed", n, "s"), ("acceleration", 2 * n, "s^2")):
        heads = "".join(f"{label:>12}" for label in labels)
        print(f"\nrms error of the {title}\n  {'joint':<{width}} {'':8}{heads}")
        for k, joint in enumerate(chain.moving):
            cells = "".join(f"{row[first + k]:>12.3g}" for row in errors)
            print(f"  {joint.name:<{width}} {joint.unit + '/' + power:<8}{cells}")


def random_placement(problem, count, random):
    found = ()
    for i in random.permutation(len(problem.places)):
        if len(found) < count and problem.fits((*found, i)):
            found = (*found, int(i))
    return found


def report(chain, problem, choices, options):
    import numpy as np

    best, n = choices[-1], chain.n
    random = np.random.default_rng(options.seed)
    some = [random_placement(problem, options.count, random) for _ in range(RANDOM)]
    scores = problem.scores(some)
    order = np.argsort(scores, kind="stable")
    typical, worst = some[order[RANDOM // 2]], some[order[-1]]
    compared = [choice.placement for choice in choices]
    labels = [f"{len(each)} IMU{'s' if len(each) > 1 else ''}" for each in compared]
    if not options.no_encoders:
        compared, labels = [(), *compared], ["encoders", *labels]
    errors = problem.errors([*compared, typical, worst])
    what = f"motion of {options.motion}" if options.motion else f"sums of sines, seed {options.seed}"
    print(f"{chain.name}: {n} joints, {len(problem.places)} candidates on "
          f"{len({place.link for place in problem.places})} links, "
          f"encoders {'off' if options.no_encoders else 'on'}")
    print(f"motion     {what}, {len(problem.motion) / problem.motion.rate_hz:g} s")
    print(f"search     {best.search}, {best.evaluated} placements, "
          f"{options.criterion} of the {options.measure}")
    print(f"score      {best.score:.4g}; of {RANDOM} random placements: best {scores[order[0]]:.4g}, "
          f"median {scores[order[RANDOM // 2]]:.4g}, worst {scores[order[-1]]:.4g} (less is better)")
    if best.bound is not None and best.search != "exhaustive":
        print(f"bound      no placement of {options.count} is below {best.bound:.4g}")
    print("sensors")
    for number, index in enumerate(best.placement, 1):
        print(f"  {number}  {describe(problem.places[index])}")
    links = {problem.places[index].link for index in best.placement}
    if options.robot.endswith((".yaml", ".yml")) and len(links) == len(best.placement):
        named = ", ".join(link for link in chain.moving_links() if link in links)
        print(f"in device.yaml\n  estimation: {{inertial_units: [{named}]}}")
    table(chain, errors, [*labels, "median", "worst"])
    print("\nmedian, worst: of the random placements of as many sensors. Sensors without bias and with "
          "known mounting.")
    summary = {
        "robot": chain.name, "joints": [joint.name for joint in chain.moving],
        "units": [joint.unit for joint in chain.moving], "options": vars(options),
        "candidates": [{"link": place.link, "r_m": place.r} for place in problem.places],
        "choices": [{"placement": choice.placement, "score": choice.score, "search": choice.search,
                     "evaluated": choice.evaluated, "bound": choice.bound} for choice in choices],
        "random": {"scores": sorted(float(score) for score in scores), "median": typical,
                   "worst": worst},
        "rms_errors": [{"sensors": placement, "q": row[:n].tolist(), "dq": row[n:2 * n].tolist(),
                        "ddq": row[2 * n:].tolist()}
                       for placement, row in zip([*compared, typical, worst], errors, strict=True)]}
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(summary, indent=1) + "\n", encoding="utf-8")
    if options.picture:
        from hapticgiant.imus import picture
        first = errors[:len(compared)]
        if options.no_encoders:
            first = np.concatenate([np.full((1, 3 * n), np.nan), first])
        picture.draw(options.picture, chain, problem.motion, problem.places, best.placement, first,
                     not options.no_encoders)


def run(options):
    """Places the sensors of the options and reports. Raises InputError."""
    from hapticgiant.imus import motion, placement
    from hapticgiant.imus.chain import InputError

    if options.picture and pathlib.Path(options.picture).suffix not in (".svg", ".png", ".pdf"):
        raise InputError(f"--picture: '{options.picture}': expected .svg, .png or .pdf")
    if options.duration * options.rate < LEAST_S * max(options.rate, 40 / LEAST_S):
        raise InputError(f"--duration: expected at least {LEAST_S} s and 40 samples")
    chain, middle, columns = robot(options.robot)
    moved = (motion.from_table(chain, options.motion, options.rate, columns) if options.motion
             else motion.sines(chain, options.seed, options.duration, options.rate, middle))
    noise = placement.Noise(options.gyro, options.accelerometer, options.encoder,
                            options.encoder_slide, options.jerk, options.jerk_slide,
                            not options.no_encoders)
    places = places_of(chain, options)
    problem = placement.Problem(chain, moved, places, noise, not options.no_gravity,
                                options.measure, options.criterion, options.one_per_link)
    report(chain, problem, placement.place(problem, options.count, options.exhaustive), options)
    return 0


def main(words):
    from hapticgiant.command_line import INTERRUPTED, exit_code_of

    options = parser().parse_args(words)
    try:
        from hapticgiant.imus.chain import InputError
        if options.robot.endswith((".yaml", ".yml")):
            import yaml  # noqa: F401
        if options.picture:
            import matplotlib  # noqa: F401
    except ImportError as error:
        print(f"imus: {sys.executable}: {error}: tools/setup.sh build, or pip install "
              "'hapticgiant[report]'", file=sys.stderr)
        return 2
    try:
        return exit_code_of("imus", lambda: run(options), (InputError,))
    except KeyboardInterrupt:
        return INTERRUPTED


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
