#!/usr/bin/env python3
"""Renames the types and functions whose names stand in many namespaces. Re-runnable, idempotent.

    renames.py ROOT [--dry]     then clang-format on every C++ file that changed

Works on the tokens of every tracked .h and .cpp file: an unqualified name is looked up in the
namespaces around it, as C++ does, and in `using namespace x;` and `using x::Name;` of the file; a
qualified one by its namespace. Strings, #include lines, members (.x, ->x) and names of classes'
own types (FlightRecorder::Result) stay. In comments and in docs: qualified names, check(Type),
check() and step(), and the fixed sentences below. Free functions are told apart by the text of
their arguments. Exits with 1 and one line for every call that no rule covers.
"""

import pathlib
import re
import subprocess
import sys

# (namespace, type) -> new name
TYPES = {
    ("hg::controller", "State"): "CycleState",
    ("hg::controller", "Config"): "CycleConfig",
    ("hg::rendering", "State"): "RenderingState",
    ("hg::rendering", "Options"): "RenderingOptions",
    ("hg::rendering", "Motion"): "DeviceMotion",
    ("hg::surfaces", "State"): "EnvironmentState",
    ("hg::estimation", "State"): "EstimationState",
    ("hg::estimation", "Config"): "EstimationConfig",
    ("hg::prepositioning", "Config"): "PrepositioningConfig",
    ("hg::prepositioning", "Command"): "GantryCommand",
    ("hg::tracking", "State"): "ControlState",
    ("hg::tracking", "Config"): "ControlConfig",
    ("hg::safety", "State"): "SafetyState",
    ("hg::safety", "Event"): "SafetyEvent",
    ("hg::safety", "Verdict"): "MonitorResult",
    ("hg::collision", "State"): "CollisionState",
    ("hg::collision", "Config"): "CollisionConfig",
    ("hg::passivity", "State"): "PassivityState",
    ("hg::passivity", "Config"): "PassivityConfig",
    ("hg::passivity", "Input"): "PassivityInput",
    ("hg::compliance", "State"): "ComplianceState",
    ("hg::compliance", "Config"): "ComplianceConfig",
    ("hg::compliance", "Input"): "ComplianceInput",
    ("hg::simulator", "Config"): "SimulatorConfig",
    ("hg::person", "Config"): "PersonConfig",
    ("hg::runtime", "Options"): "RuntimeOptions",
    ("hg::runtime", "Report"): "RuntimeReport",
    ("hg::viewer_server", "Options"): "ServerOptions",
    ("hg::scenario", "Options"): "ScenarioOptions",
    ("hg::config", "Device"): "DeviceConfig",
    ("hg::config", "Simulation"): "SimulationConfig",
    ("hg::analysis", "Event"): "RunEvent",
    ("hg::udp", "Verdict"): "DatagramCheck",
    ("hg::udp", "Refusal"): "ConnectionRefusal",
    ("hg::start_test", "Result"): "StartTestResult",
    ("hg::checks", "Workspace"): "HandleWorkspace",
    ("hg::studies", "Verdict"): "DecayClass",
    ("hg::haptify", "Options"): "HaptifyOptions",
    ("hg::tuning", "Device"): "TunedDevice",
    ("hg::bench", "Verdict"): "ComparisonVerdict",
}

# (namespace, function) -> [(regex that the text of the arguments matches, new name or None)];
# the first that matches counts, None = stays; the last name is that of a bare "check()" in words.
FUNCTIONS = {
    ("hg::limits", "check"): [(r"[rR]esponse|\bdrive\b", "check_drive_response"),
                              (r"RecoverableOptions|^options\b", "check_recoverable_options"),
                              (r"^arguments\.\.\.", None),
                              (r"JointLimits|limits|joint|axis", "check_joint_limits")],
    ("hg", "check"): [(r"DeviceModel|^device", "check_device_model"), (r".", None)],
    ("hg::model", "check"): [(r".", "check_inertial")],
    ("hg::runtime", "check"): [
        (r"ThreadOptions|\bthread$|^\{\s*\.(priority|cpu)\b", "check_thread_options"),
        (r"Options|options|^\{", "check_runtime_options")],
    ("hg::hqp", "check"): [(r"SolverOptions|options", "check_solver_options"),
                           (r"Capacity|capacity", "check_capacity")],
    ("hg::person", "check"): [(r"[Ww]alk", "check_walk"),
                              (r"HandImpedance|hand|^h$", "check_hand_impedance")],
    ("hg::simulator", "check"): [(r".", "check_plant_config")],
    ("hg::recording", "check"): [(r".", "check_recording_info")],
    ("hg::viewer_server", "check"): [(r"Options|options", "check_server_options"),
                                     (r"Scene|scene", "check_scene")],
    ("hg::rendering", "check"): [(r"DeviceModel|^device\b", "check_rendering"),
                                 (r"TwinModel|twin|model", "check_twin_model")],
    ("hg::surfaces", "check"): [(r"vector|surfaces", "check_surfaces"),
                                (r"Surface|surface", "check_surface")],
    ("hg::prepositioning", "check"): [(r".", "check_prepositioning")],
    ("hg::collision", "check"): [(r".", "check_collision")],
    ("hg::tracking", "check"): [(r".", "check_control_config")],
    ("hg::passivity", "check"): [(r".", "passivity_fault")],
    ("hg::apps", "check"): [(r"rates_Hz", "check_rates"), (r".", None)],
    ("hg::python", "check"): [(r"^given, \"JointLimits\"", "check_joint_limits"),
                              (r"^options, joint\b", "check_recoverable_options"),
                              (r"^drive\b", "check_drive_response"), (r".", None)],
    ("hg::prepositioning", "step"): [(r"^const (VectorP|RobotState)\b", None), (r".", "command_gantry")],
    ("hg::passivity", "step"): [(r".", "observe_energy")],
    ("hg::compliance", "step"): [(r".", "react_to_contact")],
}

# function of a type, for "check(Type)" and for "check()" in the comment above the type
CHECK_OF = {
    "JointLimits": "check_joint_limits", "RecoverableOptions": "check_recoverable_options",
    "DriveResponse": "check_drive_response", "Inertial": "check_inertial", "DeviceModel": "check_device_model",
    "RuntimeOptions": "check_runtime_options", "ThreadOptions": "check_thread_options",
    "SolverOptions": "check_solver_options", "Capacity": "check_capacity",
    "Walk": "check_walk", "HandImpedance": "check_hand_impedance",
    "PlantConfig": "check_plant_config", "Scene": "check_scene",
    "ServerOptions": "check_server_options", "TwinModel": "check_twin_model",
    "Surface": "check_surface", "PrepositioningConfig": "check_prepositioning",
    "ControlConfig": "check_control_config",
}

TYPE_NAMES = {name for _, name in TYPES}
FUNCTION_NAMES = {name for _, name in FUNCTIONS}

# (path, regex, replacement): words that no rule of above reaches
FIXED = [
    ("hg/limits/test/recoverable_bounds_test.cpp", r"// What check\w*\(\) says, empty when it accepts\.",
     "// Message of the check of these arguments; empty when they pass."),
    ("hg/limits/test/recoverable_bounds_test.cpp", r"\n    check\(arguments\.\.\., kItem\);",
     """
    if constexpr (sizeof...(arguments) == 1) {
      check_joint_limits(arguments..., kItem);
    } else {
      check_recoverable_options(arguments..., kItem);
    }"""),
    ("hg/controller/rendering/surfaces/environment.h", r"/// check_surface\(\)", "/// check_surfaces()"),
    ("hg/config/simulation_schema.h", r"becomes a Simulation\b", "becomes a SimulationConfig"),
    ("hg/config/device_schema.h", r"becomes a Device\b", "becomes a DeviceConfig"),
    ("hg/controller/safety/transitions.cpp", r"in the order of Event\b", "in the order of SafetyEvent"),
]

CHANGE = """- Types carry their subject, for a search: `controller::Config` is `CycleConfig`, `config::Device` `DeviceConfig`, `safety::State`
  `SafetyState`, `runtime::Options` `RuntimeOptions`; so do the functions `check()` and `step()` of the rooms: `check_joint_limits()`,
  `observe_energy()`. Recordings and Python keep their names.
"""

KEPT_SUITES = re.compile(r"TEST(_P)?$|INSTANTIATE_TEST_SUITE_P$|RC_GTEST_PROP$")

TOKEN = re.compile(r"""
    (?P<comment>//(?:[^\n\\]|\\.)*|/\*.*?\*/)
  | (?P<include>^[ \t]*\#[ \t]*include[^\n]*)
  | (?P<raw>R"(?P<delimiter>[^()\s]*)\(.*?\)(?P=delimiter)")
  | (?P<string>"(?:[^"\\\n]|\\.)*")
  | (?P<char>(?<![0-9a-fA-F])'(?:[^'\\\n]|\\.)+')
  | (?P<word>[A-Za-z_]\w*)
  | (?P<number>\d(?:[\w.]|'(?=\w))*)
  | (?P<space>\s+)
  | (?P<mark>::|->|.)
""", re.VERBOSE | re.DOTALL | re.MULTILINE)


def cpp_files(root):
    names = subprocess.check_output(["git", "ls-files", "*.h", "*.cpp", "*.h.in"], cwd=root,
                                    text=True)
    return [root / name for name in names.split()]


def doc_files(root):
    names = subprocess.check_output(["git", "ls-files", "*.md"], cwd=root, text=True).split()
    return [root / name for name in names if name != "CHANGELOG.md"]


def known_namespaces(texts):
    known = set()
    for text in texts:
        for name in re.findall(r"^\s*namespace ([\w:]+) \{", text, re.MULTILINE):
            parts = name.split("::")
            known |= {"::".join(parts[:n]) for n in range(1, len(parts) + 1)}
    known |= {namespace for namespace, _ in TYPES} | {namespace for namespace, _ in FUNCTIONS}
    return known


class Renamer:
    def __init__(self, namespaces):
        self.namespaces = namespaces
        self.faults = []

    def resolve_namespace(self, qualifier, around):
        """Full name of `qualifier` ("tracking", "hg::limits") seen from the namespace `around`."""
        parts = around.split("::") if around else []
        for length in range(len(parts), -1, -1):
            full = "::".join(parts[:length] + qualifier)
            if full in self.namespaces:
                return full
        return None

    def places(self, qualifier, around, used):
        """Namespaces in which a name is looked up, in order."""
        if qualifier:
            full = self.resolve_namespace(qualifier, around)
            return [full] if full else []
        parts = around.split("::") if around else []
        found = ["::".join(parts[:n]) for n in range(len(parts), 0, -1)]
        return found + used

    def new_type(self, name, qualifier, around, used):
        for place in self.places(qualifier, around, used):
            if (place, name) in TYPES:
                return TYPES[place, name]
        return None

    def new_function(self, name, qualifier, around, used, arguments, where):
        for place in self.places(qualifier, around, used):
            for pattern, new in FUNCTIONS.get((place, name), []):
                if re.search(pattern, arguments, re.DOTALL):
                    return new
            if (place, name) in FUNCTIONS:
                self.faults.append(f"{where}: no rule for {place}::{name}({arguments})")
                return None
        return None

    def words(self, text, around, used, subject=None):
        """A comment or a page: qualified names, check(Type), check() and step()."""
        def chain(match):
            qualifier = match[1].rstrip(":").split("::")
            new = self.new_type(match[2], qualifier, around, used)
            return match[1] + new if new else match[0]

        names = sorted({name for _, name in TYPES}, key=len, reverse=True)
        text = re.sub(r"\b((?:[a-z]\w*::)+)(" + "|".join(names) + r")\b", chain, text)

        def call(match):
            qualifier = match[1].rstrip(":").split("::") if match[1] else []
            kind = match[3].split("::")[-1]
            kind = self.new_type(kind, qualifier, around, used) or kind
            if match[2] == "check" and kind in CHECK_OF:
                return match[1] + CHECK_OF[kind] + "()"
            if kind:
                return match[0]
            if match[2] == "check" and subject in CHECK_OF:
                return match[1] + CHECK_OF[subject] + "()"
            for place in self.places(qualifier, around, used):
                if (place, match[2]) in FUNCTIONS:
                    return match[1] + (FUNCTIONS[place, match[2]][-1][1] or match[2]) + "()"
            return match[0]

        text = re.sub(r"(?<![.\w>])((?:[a-z]\w*::)*)(check|step)\(((?:[a-z]\w*::)*[A-Z]\w*|)\)",
                      call, text)

        def bare(match):  # `passivity::step` without brackets
            qualifier = match[1].rstrip(":").split("::")
            for place in self.places(qualifier, around, used):
                if (place, match[2]) in FUNCTIONS:
                    return match[1] + (FUNCTIONS[place, match[2]][-1][1] or match[2])
            return match[0]

        return re.sub(r"\b((?:[a-z]\w*::)+)(check|step)\b(?!\()", bare, text)

    def cpp(self, text, path):
        tokens = []
        for match in TOKEN.finditer(text):
            kind = match.lastgroup
            if match["raw"] is not None:
                kind = "raw"
            tokens.append([kind, match[0]])
        code = [i for i, (kind, _) in enumerate(tokens) if kind not in ("space", "comment")]
        position = {i: n for n, i in enumerate(code)}

        def at(n):
            return tokens[code[n]][1] if 0 <= n < len(code) else ""

        stack = []  # an entry per open brace: a namespace's parts, or None
        pending = None  # parts of a namespace whose brace comes next
        around = ""
        used = []
        aliases = {}
        line = 1
        after = {}  # comments wait for the subject behind them
        out = []

        for i, (kind, value) in enumerate(tokens):
            new = value
            if kind == "comment":
                after[len(out)] = around
            elif kind == "mark" and value == "{":
                stack.append(pending)
                pending = None
                around = "::".join(part for parts in stack if parts for part in parts)
            elif kind == "mark" and value == "}":
                if stack:
                    stack.pop()
                around = "::".join(part for parts in stack if parts for part in parts)
            elif kind == "word" and value == "namespace":
                n = position[i]
                parts, m = [], n + 1
                while at(m) not in ("{", ";", "="):
                    if at(m) != "::":
                        parts.append(at(m))
                    m += 1
                if at(n - 1) == "using":
                    full = self.resolve_namespace(parts, around)
                    if full:
                        used.append(full)
                elif at(m) == "{":
                    pending = parts
            elif kind == "word":
                new = self.word(value, position[i], at, around, used, aliases, f"{path}:{line}")
            out.append(new)
            line += value.count("\n")

        first = re.search(r"^namespace (hg[\w:]*) \{", text, re.MULTILINE)
        for n, around_comment in after.items():
            around_comment = around_comment or (first[1] if first else "hg")
            out[n] = self.words(out[n], around_comment, used, self.subject_after(tokens, n, out))
        return hoisted("".join(out))

    def page(self, text):
        """A page of the docs: words, and the C++ in it as code."""
        parts = re.split(r"(^```cpp\n.*?^```)", text, flags=re.MULTILINE | re.DOTALL)
        for n, part in enumerate(parts):
            parts[n] = self.cpp(part, "docs") if n % 2 else self.words(part, "hg", [])
        return "".join(parts)

    def subject_after(self, tokens, n, out):
        """Name of the struct, class or enum behind the comment at n, else None."""
        rest = [out[m] for m in range(n, min(n + 60, len(tokens)))
                if tokens[m][0] not in ("space", "comment")][:2]
        if len(rest) == 2 and rest[0] in ("struct", "class"):
            return rest[1]
        return None

    def word(self, name, n, at, around, used, aliases, where):
        qualifier, m = [], n - 1
        while at(m) == "::":
            if not re.match(r"\w", at(m - 1)):
                break
            qualifier.insert(0, at(m - 1))
            m -= 2
        if at(m) in (".", "->") and not (at(m) == "." and at(m - 1) == "."):
            return name

        if name in TYPE_NAMES:
            if at(n - 1) == "(" and KEPT_SUITES.match(at(n - 2)):
                return name
            if qualifier and qualifier[-1] == name:  # constructor
                return self.new_type(name, qualifier[:-1], around, used) or name
            new = self.new_type(name, qualifier, around, used)
            if new is None and not qualifier:
                new = aliases.get(name)
            if new and at(m) == "using" and at(n + 1) == ";":
                aliases[name] = new
            return new or name
        if name in FUNCTION_NAMES and at(n + 1) == "(":
            depth, k, text = 0, n + 1, []
            while k < n + 400:
                depth += {"(": 1, "{": 1, ")": -1, "}": -1}.get(at(k), 0)
                if depth == 0:
                    break
                text.append(at(k))
                k += 1
            arguments = " ".join(text[1:])
            arguments = re.sub(r" (?=[,.)\]&*:(])|(?<=[.(\[:&]) ", "", arguments)
            arguments = re.sub(r"(?<=\w)([&*])(?=\w)", r"\1 ", arguments)
            return self.new_function(name, qualifier, around, used, arguments, where) or name
        return name


def hoisted(text):
    """Puts the comment behind a member above it where the line is too long with its new name."""
    lines, out = text.split("\n"), []
    for n, line in enumerate(lines):
        match = re.match(r"(\s*)(\S.*?\S)\s+///< (.*)$", line)
        follows = n + 1 < len(lines) and re.match(r"\s*///<", lines[n + 1])
        if match and len(match[1]) + len(match[2]) + len(match[3]) + 7 > 100 and not follows:
            comment = match[3][0].upper() + match[3][1:]
            out.append(f"{match[1]}/// {comment}")
            line = match[1] + match[2]
        out.append(line)
    return "\n".join(out)


def check_table():
    """No new name may be the old name of another rule in its namespace."""
    faults = []
    for (namespace, old), new in TYPES.items():
        if (namespace, new) in TYPES:
            faults.append(f"{namespace}::{new} is both old and new")
    return faults


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    dry = "--dry" in sys.argv
    files = cpp_files(root)
    texts = {path: path.read_text() for path in files}
    renamer = Renamer(known_namespaces(texts.values()))
    faults = check_table()
    changed = []
    for path, text in texts.items():
        name = str(path.relative_to(root))
        new = renamer.cpp(text, name)
        for where, pattern, replacement in FIXED:
            if re.fullmatch(where, name):
                new = re.sub(pattern, replacement, new)
        if new != text:
            changed.append(path)
            if not dry:
                path.write_text(new)
    gantry = (root / "hg/controller/prepositioning/prepositioning.h").read_text()
    gantry = "`Prepositioning::step`" if "class Prepositioning" in gantry else "`command_gantry`"
    pages = []
    for path in doc_files(root):
        text = path.read_text()
        new = renamer.page(text)
        new = new.replace("`prepositioning::command_gantry`", gantry)
        for where, pattern, replacement in FIXED:
            if re.fullmatch(where, str(path.relative_to(root))):
                new = re.sub(pattern, replacement, new)
        if new != text:
            pages.append(path)
            if not dry:
                path.write_text(new)
    log = root / "CHANGELOG.md"
    text = log.read_text()
    if changed and not dry and CHANGE not in text:
        log.write_text(text.replace("\n### Control\n", CHANGE + "\n### Control\n", 1))
    if changed and not dry:
        for start in range(0, len(changed), 40):
            subprocess.run(["clang-format", "-i", *map(str, changed[start:start + 40])], check=True)
    for fault in faults + renamer.faults:
        print(fault)
    print(f"{len(changed)} C++ files, {len(pages)} pages")
    return 1 if faults + renamer.faults else 0


if __name__ == "__main__":
    sys.exit(main())
