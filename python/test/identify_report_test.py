"""What `hapticgiant identify` prints: every line, and what is not usable.

Usage: identify_report_test.py   (from anywhere; no compiled part)
"""

import contextlib
import io
import unittest

from report_test import said

from hapticgiant.report import identify

LINK_KEYS = ("mass_kg", "com_x_m", "com_y_m", "com_z_m", "ixx_kg_m2", "ixy_kg_m2", "iyy_kg_m2",
             "ixz_kg_m2", "iyz_kg_m2", "izz_kg_m2")


def found(value=None, deviation=0.0, **files):
    return files | ({"is_found": False} if value is None else
                    {"is_found": True, "value": value, "deviation": deviation})


def results(identified, **more):
    return {"kind": "identify", "identified": identified, "file": "a.mcap", "losses": "lost\n",
            "used_s": 55.5, **more}


def slid(**more):
    return {"name": "m1", "coulomb_friction_Nm": found(5.341, 0.00801, device_file=4),
            "load_friction": found(device_file=0.06), "presliding_elements": 2, "residual_Nm": 0.52,
            "forward_s": 26.4, "backward_s": 27, "reversals": 61, "speed_rad_per_s": 1.744,
            "missing": ["load friction: slide"], **more}


def elastic(**more):
    return {"name": "m1", "stiffness_Nm_per_rad": found(10900.0, 54.5, files=12000.0),
            "damping_Nms_per_rad": found(files=0.0), "torque_Nm": 13.25, "twist_rad": 0.0012,
            "unexplained_twist_rad": 1e-6, "missing": ["damping: shake it"], **more}


def driven(**more):
    return {"name": "elbow", "delay_s": found(0.009766, 5e-5, files=0.00975),
            "lag_s": found(files=0.0, less_than=0.002), "commanded_rad_per_s": 0.45,
            "unexplained_rad": 4e-5, "missing": [], **more}


def inertial(figure, **more):
    return {"urdf": figure, "value": 1.5 * figure, "deviation": 0.01, "is_found": True, **more}


def moved(**more):
    link = {"name": "link1", **{key: inertial(0.1 * place, is_found=key != "izz_kg_m2")
                                for place, key in enumerate(LINK_KEYS)}}
    joint = {"name": "m1", "way_rad": 1.69, "acceleration_rad_per_s2": 1.23,
             "unexplained_Nm": 0.507, "unexplained_by_files_Nm": 0.936}
    base = [inertial(2.0, name="m1 I_zz"), inertial(-1.0, name="x" * 61, is_found=False)]
    return results("inertia", **{"joints": [joint], "missing": "", "base": base,
                                 "links": [link], **more})


def weighed(**more):
    return {"kind": "identify", "identified": "payload", "poses": 12, "files": [], "device": "Arm",
            "mass_kg": 1.1775, "mass_deviation_kg": 0.0033, "com_m": [0.0, -0.0003, 0.03],
            "com_deviation_m": 0.0001, "offset": [1.08, 0.4, -4.1, -0.2, -0.1, 0.0],
            "residual_N": 0.111, "residual_Nm": 0.002, "condition": 1.1, "doubts": [],
            "missing": "", **more}


class Identify(unittest.TestCase):
    def check(self, given, text, complaint="", code=0):
        with contextlib.redirect_stderr(io.StringIO()) as complaints:
            self.assertEqual(said(identify.write, given, None), (code, text))
        self.assertEqual(complaints.getvalue(), complaint)

    def test_friction(self):
        text = ("lost\na.mcap: 1 joints, drives on for 55.5 s\n\n"
                "m1  slid 26 s forward, 27 s backward, 61 reversals, up to 1.74 rad/s; 0.52 Nm rms "
                "unexplained\n"
                "  coulomb_friction_Nm                5.34 +- 0.00801    device file 4\n"
                "  load_friction                         -               device file 0.06\n"
                "  not found: load friction: slide\n")
        self.check(results("friction", joints=[slid()]), text + (
            "\nfor device.yaml, into the entry of each joint:\nactuators:\n  m1:\n"
            "    coulomb_friction_Nm: 5.34  # +- 0.00801\n    presliding_elements: 2\n"))
        unmoved = slid(coulomb_friction_Nm=found(device_file=4))
        line = "  coulomb_friction_Nm                5.34 +- 0.00801    device file 4\n"
        self.check(results("friction", joints=[unmoved]), text.replace(
            line, "  coulomb_friction_Nm                   -               device file 4\n"),
                   "not usable: no joint moved enough for its friction\n", 2)

    def test_stiffness_and_damping(self):
        text = ("lost\na.mcap: 1 joints, drives on for 55.5 s; +- is the 95 % interval\n\n"
                "m1  torque 13.2 Nm rms, twist 0.0012 rad rms, 1e-06 rad rms unexplained\n"
                "  stiffness_Nm_per_rad     1.09e+04 +- 109        files 1.2e+04\n"
                "  damping_Nms_per_rad             -               files -\n"
                "  not found: damping: shake it\n")
        self.check(results("joints", joints=[elastic()]), text + (
            "\nfor device.yaml, into the entry of each joint (and 'stiffness: 1', 'damping: 1' "
            "under 'factors' of the simulation file):\nactuators:\n  m1:\n"
            "    stiffness_Nm_per_rad: 1.09e+04  # +- 109\n"))
        unmoved = elastic(stiffness_Nm_per_rad=found(files=12000.0))
        self.check(results("joints", joints=[unmoved]),
                   text.replace("1.09e+04 +- 109   ", "       -          "),
                   "not usable: no joint moved enough for its stiffness or delay\n", 2)

    def test_delays(self):
        all_drives = {"delay_s": found(0.00975, 2.5e-5, files=0.00975),
                      "latency_s": found(0.008, 2.5e-5, files=0.0085)}
        head = "lost\na.mcap: 2 joints, drives on for 55.5 s; +- is the 95 % interval\n"
        delays = ("\nelbow  commanded 0.45 rad/s rms, 4e-05 rad rms unexplained\n"
                  "  from command to position    9.77 ms +- 0.10\n"
                  "  of that, first-order lag       - (less than 2.0 ms)\n")
        lagging = driven(lag_s=found(0.003, 1e-4, files=0.0))
        self.check(results("joints", joints=[driven(), lagging], **all_drives), head + (
            "stiffness and damping: not in this recording, the device does not report motors, "
            f"joints and joint torques\n{delays}") + delays.replace(
                "      - (less than 2.0 ms)", "   3.00 ms +- 0.20") +
            "\nfor the simulation file:\ndrives:\n"
            "  latency_s: 0.00800  # +- 0.00005, file 0.00850\n")
        both = [driven() | elastic(name="elbow"), driven(delay_s=found(files=0.01)) | elastic()]
        code, text = said(identify.write, results("joints", joints=both, **all_drives), None)
        self.assertEqual(code, 0)
        self.assertNotIn("not in this recording", text)
        self.assertIn(f"{delays}  not found: damping: shake it\n\nm1  torque", text)
        self.assertEqual(text.count("from command"), 1)
        stiffness = "      stiffness_Nm_per_rad: 1.09e+04  # +- 109\n"
        self.assertTrue(text.endswith(f"0.00850\n  actuators:\n    elbow:\n{stiffness}    m1:\n"
                                      f"{stiffness}"), text)

    def test_inertia(self):
        head = ("lost\na.mcap: drives on for 55.5 s; +- is the 95 % interval\n"
                "m1                     moved over 1.69 rad, 1.2 rad/s^2 rms; 0.507 Nm rms "
                "unexplained, 0.936 by the files\n")
        rows = "\n".join(f"  {key:<12}{0.1 * place:10.4f} {0.15 * place:10.4f}    0.0200"
                         for place, key in enumerate(LINK_KEYS))
        self.check(moved(), head + (
            "\n1 of 2 base parameters show (kg, kg m, kg m^2):\n      URDF      found        +-\n"
            "    2.0000     3.0000    0.0200  m1 I_zz\n"
            f"   -1.0000    -1.5000    0.0200  {60 * 'x'} ...  (open)\n\n"
            f"link1               URDF      found        +-\n{rows}  mostly the URDF's\n\n"
            "for the URDF, all of them together:\n<!-- link1 -->\n<inertial>\n"
            '  <origin xyz="0.15 0.3 0.45" rpy="0 0 0"/>\n  <mass value="0"/>\n'
            '  <inertia ixx="0.6" ixy="0.75" ixz="1.05" iyy="0.9" iyz="1.2" izz="1.35"/>\n'
            "</inertial>\n"))
        self.check(moved(missing="record longer"), head, "not usable: record longer\n", 2)

    def test_payload(self):
        text = ("12 poses of the simulated Arm, handle not held\n\n"
                "mass            1.1775 kg, +-0.0033\n"
                "centre of mass  0.0000, -0.0003, 0.0300 m in S, +-0.0001\n"
                "sensor offset   1.08, 0.40, -4.10 N; -0.2000, -0.1000, 0.0000 Nm\n"
                "residuals       0.111 N, 0.0020 Nm rms\n"
                "condition       1.1  (1 = every direction shows alike)\n")
        yaml = ("\nfor device.yaml:\npayload:\n  mass_kg: 1.1775\n"
                "  centre_of_mass_m: [0.0000, -0.0003, 0.0300]\n"
                "  # inertia_kg_m2 does not show at rest: from the drawing\n")
        self.check(weighed(), text + yaml)
        compared = "device.yaml     mass +17.75 %, centre of mass 10.0 mm from its values\n"
        self.check(weighed(device_file={"mass_kg": 1.0, "com_m": [0.0, -0.0003, 0.02]},
                           doubts=["f: counts"]), text + compared + yaml, "WARNING f: counts\n")
        unseen = text.replace("+-0.0001", "+-inf").replace("1.1  (1 =", "inf  (1 =")
        self.check(weighed(files=["a.csv", "b.csv"], com_deviation_m=None, condition=None,
                           missing="more poses"),
                   unseen.replace("of the simulated Arm, handle not held", "from a.csv, b.csv"),
                   "not usable: more poses\n", 2)


if __name__ == "__main__":
    unittest.main()
