"""Python has every enumerator of the C++ headers, under its own name."""

import pathlib
import re
import unittest

import hapticgiant as hg
from hapticgiant import haptic_giant, hqp

HEADERS = pathlib.Path(__file__).parents[2] / "hg"
ENUMS = {
    hg.Mode: "signals/state.h",
    hg.ModeRequest: "signals/frames.h",
    hg.Stop: "signals/state.h",
    hg.TareStatus: "signals/state.h",
    hg.Refusal: "signals/state.h",
    hg.SolverStatus: "signals/state.h",
    hg.FaultCode: "signals/fault.h",
    hg.LimitState: "signals/limit.h",
    hg.LimitCause: "signals/limit.h",
    hg.Parameter: "signals/twin_input.h",
    hg.ChangeStatus: "signals/state.h",
    hg.Law: "controller/rendering/options.h",
    hg.Bounds: "controller/rendering/options.h",
    hg.Gantry: "controller/rendering/options.h",
    hqp.Status: "hqp/solution.h",
    hqp.RowState: "hqp/solution.h",
    haptic_giant.InverseStatus: "model/haptic_giant.h",
}
# a row that is not right is a ValueError
ABSENT = {"BAD_ROW"}


def enumerators(header: str, enum: str) -> list[str]:
    """Names in the header, as constants: kStillMoving is STILL_MOVING."""
    source = re.sub(r"//.*", "", (HEADERS / header).read_text())
    body = re.search(rf"enum class {enum}\b[^{{]*\{{([^}}]*)\}}", source)[1]
    names = re.findall(r"\bk([A-Z]\w*)", body)
    return [re.sub(r"(?<!^)(?=[A-Z])", "_", name).upper() for name in names]


class Enums(unittest.TestCase):
    def test_each_has_all_of_its_header(self):
        for enum, header in ENUMS.items():
            with self.subTest(enum.__name__):
                names = enumerators(header, enum.__name__)
                self.assertEqual(sorted(one.name for one in enum), sorted(set(names) - ABSENT))

    def test_every_enum_is_looked_at(self):
        public = [hg, hqp, haptic_giant]
        names = {x for module in public for x in vars(module).values() if hasattr(x, "__members__")}
        self.assertEqual(names, set(ENUMS))


if __name__ == "__main__":
    unittest.main()
