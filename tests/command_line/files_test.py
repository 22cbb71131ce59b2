"""Names on the command line that are no files, or files of another user.

Usage: files_test.py PROGRAM   (from the repository root)
"""

import os
import pathlib
import socket
import unittest

from program import MODELS, TemporaryFolder, run

SHORT = ("run", "door", "--fast", "--user", "none", "--duration", "0.2")


class Names(TemporaryFolder):
    def refused(self, *arguments, message, timeout=60):
        code, out, err = run(*arguments, timeout=timeout)
        self.assertEqual(code, 2, (arguments, out, err))
        self.assertIn(message, err, arguments)
        self.assertEqual(err.count("\n"), 1, err)

    def test_nothing_is_no_name(self):
        for option in ("--key-file", "--summary", "--recordings", "--device", "--twin", "--user",
                       "--device-address", "--bind"):
            code, out, err = run(*SHORT, "--no-recording", "--device-address", "127.0.0.1:1",
                                 option, "")
            self.assertEqual((code, out), (2, ""), option)
            self.assertIn(f"{option}: must not be empty", err)
        for command in (("explain", ""), ("run", ""), ("simulate", "--listen", ""),
                        ("simulate", "--listen", "127.0.0.1:0", "--capture="),
                        ("simulate", "--listen", "127.0.0.1:0", "--key-file", ""),
                        ("check", ""), ("plot", ""), ("bench", "--json", "")):
            code, out, err = run(*command, timeout=30)
            self.assertEqual((code, out), (2, ""), command)

    def test_a_pipe_a_socket_and_a_device_are_not_waited_for(self):
        pipe = self.folder / "pipe"
        os.mkfifo(pipe)
        place = self.folder / "socket"
        with socket.socket(socket.AF_UNIX) as bound:
            bound.bind(str(place))
            for name in (pipe, place, pathlib.Path("/dev/zero"), self.folder):
                for command in (("run", name), (*SHORT, "--twin", name), (*SHORT, "--device", name),
                                ("run", "--user", name), ("explain", name), ("replay", name),
                                ("plot", name), ("compare", name, name), ("check", name),
                                ("hqp", "solve", name), ("identify", "payload", name),
                                ("identify", "payload", "--device", name),
                                ("identify", "joints", name), ("identify", "inertia", name),
                                ("new", "device", name, "-o", self.folder / "new.yaml")):
                    code, out, err = run(*command, timeout=60)
                    self.assertEqual(code, 2, (command, out, err))
                    self.assertIn(name.name, out + err)
                listen = ("simulate", "--listen", "127.0.0.1:0")
                self.refused(*listen, "--key-file", name, message="expected a file, got"
                             if name != place else "No such device")
                if name == pathlib.Path("/dev/zero"):
                    continue
                for command in ((*SHORT, "--summary"), (*listen, "--capture"), ("check", "--json"),
                                ("doctor", "--seconds", "0.1", "--json")):
                    self.refused(*command, name, *(["x"] if command[0] == "check" else []),
                                 message="cannot be written")
        (self.folder / "s.json.partial").unlink(missing_ok=True)
        os.mkfifo(self.folder / "s.json.partial")
        self.refused(*SHORT, "--summary", self.folder / "s.json", message="named pipe")
        urdf = self.folder / "pipe.urdf"
        os.mkfifo(urdf)
        twin = (MODELS / "twins/door/twin.yaml").read_text().replace("door.urdf", "pipe.urdf")
        (self.folder / "twin.yaml").write_text(twin)
        code, _, err = run(*SHORT, "--twin", self.folder / "twin.yaml", timeout=60)
        self.assertEqual(code, 2)
        self.assertIn("pipe.urdf", err)

    def test_what_is_no_output_is_not_replaced(self):
        mine = self.folder / "mine.yaml"
        for text in ((MODELS / "scenarios/door.yaml").read_text(), "x"):
            mine.write_text(text)
            for command in ((*SHORT, "--no-recording", "--summary", mine),
                            ("check", MODELS / "haptic_giant/device.yaml", "--map", mine),
                            ("bench", "--quick", "--json", mine),
                            ("simulate", "--listen", "127.0.0.1:0", "--capture", mine)):
                self.refused(*command, message="not replaced")
            self.assertEqual(mine.read_text(), text)
        for text in ("", '{"version": 1}'):
            mine.write_text(text)
            self.assertEqual(run(*SHORT, "--no-recording", "--summary", mine)[0], 0)
            self.assertGreater(len(mine.read_text()), 1000)


if __name__ == "__main__":
    unittest.main()
