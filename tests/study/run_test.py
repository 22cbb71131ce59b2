"""`hapticgiant study run` by its pages' WebSockets: trials in real time by the scripted hand, forms, repeats, kills.

    run_test.py PROGRAM
"""

import asyncio
import csv
import json
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

import aiohttp

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
PATIENCE_S = 120
STUDY = """\
title: Two hinges
fixed: {scenario: door, duration_s: 3}
conditions:
  light: {twin.joints.hinge.damping_Nms_per_rad: 1}
  heavy: {twin.joints.hinge.damping_Nms_per_rad: 6}
design: {kind: within, order: williams, participants: 2, repetitions: 1}
instructions:
  start: {en: Hello, de: Guten Tag}
  light: {en: The light one, de: Die leichte}
breaks: {after_conditions: 1, minutes: 0.01}
questionnaires:
  tlx: {kind: nasa_tlx, weighted: true}
  own: {after: end, items: {liked: {kind: likert, points: 5, text: {en: Liked it, de: Gefiel mir}}, why: {kind: text, text: {en: Why, de: Warum}}}}
measures:
  peak_force_N: {}
"""


class Page:
    """One page's connection: its newest state, and commands."""

    def __init__(self, socket):
        self.socket, self.state, self.answers, self.number = socket, None, {}, 0
        self.news = asyncio.Condition()
        self.reader = asyncio.create_task(self.read())

    async def read(self):
        async for message in self.socket:
            words = json.loads(message.data)
            async with self.news:
                if words["kind"] == "state":
                    self.state = words
                elif words["kind"] == "answer":
                    self.answers[words["id"]] = words["problem"]
                self.news.notify_all()

    async def until(self, holds):
        async with self.news:
            await asyncio.wait_for(self.news.wait_for(lambda: self.state and holds(self.state)), PATIENCE_S)
        return self.state

    async def ask(self, command, **words):
        """The problem that is answered, None: done."""
        self.number += 1
        number = self.number
        await self.socket.send_json({"id": number, "command": command, **words})
        async with self.news:
            await asyncio.wait_for(self.news.wait_for(lambda: number in self.answers), PATIENCE_S)
        return self.answers[number]


class Running:
    """The program, and both pages."""

    def __init__(self, file, *words):
        self.command = [PROGRAM, "study", "run", file, "--rehearse", "--no-browser", *words]

    async def __aenter__(self):
        self.process = await asyncio.create_subprocess_exec(*self.command, stdout=subprocess.PIPE)
        self.links = {}
        while len(self.links) < 2:
            line = (await asyncio.wait_for(self.process.stdout.readline(), PATIENCE_S)).decode()
            assert line, "ended before its links"
            if found := re.match(r"(operator|participant) +(http://\S+?)/study/\S+#token=(\w+)", line):
                self.links[found[1]] = found[2], found[3]
        self.client = aiohttp.ClientSession()
        self.operator, self.participant = [await self.page(name) for name in ("operator", "participant")]
        return self

    async def page(self, name, token=None, **options):
        address, own = self.links[name]
        options = {"origin": address, "protocols": ("hapticgiant-study", f"token.{token or own}")} | options
        return Page(await self.client.ws_connect(f"{address}/ws/{name}", **options))

    async def __aexit__(self, *_):
        if self.process.returncode is None:
            self.process.send_signal(signal.SIGINT)
        await asyncio.wait_for(self.process.wait(), PATIENCE_S)
        await self.client.close()


def filled(form):
    answers = {item["name"]: "no words" if item["kind"] == "text" else item["low"] for item in form["items"]}
    return {"answers": answers, "pairs": {"/".join(pair): pair[0] for pair in form["pairs"]}}


async def go_through(running, until=lambda state: False):
    """Plays a participant to the end, or until a state of the operator."""
    operator, participant = running.operator, running.participant
    while True:
        state = await operator.until(lambda each: each["phase"] in ("participant", "ready", "failed", "complete"))
        if state["phase"] == "complete" or until(state):
            return state
        position = state["position"]
        assert state["phase"] != "failed", state["problem"]
        if state["phase"] == "ready":
            assert await operator.ask("start") is None
        else:
            shown = await participant.until(lambda each: each["position"] == position and each["screen"] != "waiting")
            if shown["screen"] == "form":
                assert await participant.ask("answers", position=position, **filled(shown["form"])) is None
            else:
                await asyncio.sleep(shown.get("rest_s", 0))
                assert await participant.ask("go_on", position=position) is None
        await operator.until(lambda each: each["position"] != position or each["phase"] in ("failed", "starting", "running"))
        await operator.until(lambda each: each["position"] != position or each["phase"] == "failed")


class StudyRun(unittest.IsolatedAsyncioTestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.file = self.folder / "study.yaml"
        self.file.write_text(STUDY)
        self.out = self.folder / "study.rehearsal"

    def table(self, name):
        with open(self.out / f"{name}.csv", newline="") as file:
            return list(csv.DictReader(file))

    def files(self):
        return {file.relative_to(self.out): file.read_bytes() for file in self.out.glob("sub-*/**/*") if file.is_file()}

    async def test_one_participant_from_start_to_the_tables(self):
        async with Running(self.file) as running:
            operator, participant = running.operator, running.participant
            state = await operator.until(lambda each: True)
            self.assertEqual((state["phase"], state["next"], state["people"]), ("closed", "P01", "simulated"))
            self.assertEqual((await participant.until(lambda each: True))["screen"], "waiting")
            self.assertIn("not possible now", await operator.ask("start"))
            self.assertIn("P07", await operator.ask("begin", code="P07"))
            self.assertIsNone(await operator.ask("begin", code="P01"))
            self.assertIsNone(await participant.ask("language", language="de"))
            state = await participant.until(lambda each: each["language"] == "de" and each["screen"] != "waiting")
            self.assertEqual((state["screen"], state["markdown"]), ("instruction", "Guten Tag"))
            self.assertIsNone(await operator.ask("note", text="left-handed"))

            # a trial that has been played is put aside with a reason, and played again
            state = await go_through(running, lambda each: each["last"] and "repeat" in each["can"])
            played = state["last"]
            self.assertGreater(played["measures"]["peak_force_N"]["value"], 5)
            self.assertIn("expected a text", await operator.ask("repeat", why=" "))
            self.assertIsNone(await operator.ask("repeat", why="the phone rang"))

            # a form that is not whole is not taken
            state = await go_through(running, lambda each: each["phase"] == "participant"
                                     and each["steps"][each["position"]]["kind"] == "form")
            shown = await participant.until(lambda each: each["screen"] == "form")
            words = filled(shown["form"])
            del words["answers"]["effort"]
            self.assertEqual(await participant.ask("answers", position=shown["position"], **words), "effort has no answer")
            words["answers"]["effort"] = 7
            self.assertIn("steps of 5", await participant.ask("answers", position=shown["position"], **words))
            self.assertEqual((await go_through(running))["phase"], "complete")
            self.assertIsNone(await operator.ask("leave"))
            state = await operator.until(lambda each: each["phase"] == "closed")
            self.assertEqual([each["status"] for each in state["participants"]], ["complete", "planned"])
            self.assertEqual(state["next"], "P02")
        rows = self.table("trials")
        self.assertEqual([row["position"] for row in rows], ["1", "2"])
        for row in rows:
            self.assertTrue((self.out / "sub-P01" / row["recording"]).is_file())
            self.assertEqual(row["ended_by"], "time")
        self.assertEqual(self.table("participants")[0]["put_aside"], "1")
        why, = self.out.glob("sub-P01/aside/*_why.json")
        self.assertEqual(json.loads(why.read_text())["why"], "the phone rang")
        self.assertEqual(len({row["form"] for row in self.table("answers")}), 2)
        subprocess.run(["sha256sum", "-c", "--quiet", "--strict", "hashes.sha256"], cwd=self.out, check=True)
        self.assertFalse((self.out / ".running").exists())

    async def test_killed_in_a_trial_it_continues_there_and_ends_the_device(self):
        async with Running(self.file) as running:
            self.assertIsNone(await running.operator.ask("begin", code="P01"))
            state = await go_through(running, lambda each: each["phase"] == "ready" and each["last"] is not None)
            place, before = state["position"], self.files()
            self.assertIsNone(await running.operator.ask("start"))
            await running.operator.until(lambda each: each["run"] and each["run"]["mode"] == "running")
            children = pathlib.Path(f"/proc/{running.process.pid}/task/{running.process.pid}/children").read_text().split()
            self.assertEqual(len(children), 1)
            running.process.send_signal(signal.SIGKILL)
            await running.process.wait()
            for _ in range(200):  # the device is stopped in order
                if not pathlib.Path(f"/proc/{children[0]}/exe").exists():
                    break
                await asyncio.sleep(0.1)
            else:
                self.fail("the run has outlived the study")
        self.assertEqual(before, self.files())
        async with Running(self.file) as running:
            state = await running.operator.until(lambda each: True)
            self.assertEqual(state["next"], "P01")
            self.assertIsNone(await running.operator.ask("begin", code="P01"))
            state = await running.operator.until(lambda each: each["phase"] != "closed")
            kinds = [step["kind"] for step in state["steps"][state["position"]:place + 1]]
            self.assertEqual(kinds[-1], "trial")
            self.assertNotIn("form", kinds)
            self.assertEqual((await go_through(running))["phase"], "complete")
        after = self.files()
        self.assertEqual(before, {name: after[name] for name in before})
        self.assertEqual(len(self.table("trials")), 2)

    async def test_an_aborted_trial_does_not_count(self):
        async with Running(self.file) as running:
            operator = running.operator
            self.assertIsNone(await operator.ask("begin", code="P01"))
            state = await go_through(running, lambda each: each["phase"] == "ready")
            self.assertIsNone(await operator.ask("start"))
            await operator.until(lambda each: each["run"] and each["run"]["mode"] == "running")
            self.assertIsNone(await operator.ask("stop"))
            state = await operator.until(lambda each: each["run"] and each["run"]["fault"])
            self.assertEqual(state["run"]["fault"], "emergency stop")
            self.assertIsNone(await operator.ask("abort", why="he was afraid"))
            state = await operator.until(lambda each: each["phase"] == "ready")
            self.assertIsNone(state["last"])
            self.assertEqual(state["steps"][state["position"]]["kind"], "trial")
        self.assertEqual(self.table("trials"), [])
        self.assertEqual(len(list(self.out.glob("sub-P01/aside/*_recording.mcap"))), 1)

    async def test_what_comes_before_the_run_ends_it(self):
        """Stop, abort, and Ctrl-C, while the run is only being started."""
        async with Running(self.file) as running:
            operator = running.operator
            self.assertIsNone(await operator.ask("begin", code="P01"))
            state = await go_through(running, lambda each: each["phase"] == "ready")
            for command in ({"command": "abort", "why": "too early"}, {"command": "stop"}):
                await operator.socket.send_json({"id": 1000, "command": "start"})
                while operator.state["phase"] == "ready":
                    await asyncio.sleep(0)
                self.assertIsNone(await operator.ask(**command))
                state = await operator.until(lambda each: each["phase"] == "ready")
                self.assertFalse(state["steps"][state["position"]]["is_done"])
                self.assertLess(state["position"], 3)
            for words in ({"position": 99}, {"position": None}):
                self.assertIn("another step", await operator.ask("start", **words))
            self.assertIsNone(await operator.ask("start"))
            running.process.send_signal(signal.SIGINT)
            await asyncio.wait_for(running.process.wait(), PATIENCE_S)
        self.assertEqual(self.table("trials"), [])

    async def test_a_page_that_reads_nothing_delays_no_other(self):
        text = "x" * 300_000
        self.file.write_text(STUDY.replace("en: Hello", f"en: {text}"))
        async with Running(self.file) as running:
            self.assertIsNone(await running.operator.ask("begin", code="P01"))
            address, token = running.links["participant"]
            pages = []
            for _ in range(3):  # connected, and never reads
                page = await running.client.ws_connect(f"{address}/ws/participant", origin=address, max_msg_size=0,
                                                       protocols=("hapticgiant-study", f"token.{token}"))
                page._conn.transport.pause_reading()
                pages.append(page)
            for number in range(30):
                self.assertIsNone(await running.operator.ask("note", text=f"note {number}"))
            await running.operator.until(lambda each: len(each["notes"]) == 30)
            (self.out / "sub-P01" / "sub-P01_note-1 (copy).json").write_text("of a file manager")
            self.assertIsNone(await running.operator.ask("note", text="the last one"))
            await running.operator.until(lambda each: each["notes"][-1]["text"] == "the last one")
            (self.out / "sub-P01" / "sub-P01_note-99.json").write_text("[" * 100_000)
            self.assertIn("note-99.json: is damaged", await running.operator.ask("note", text="none after this one"))
            await running.operator.until(lambda each: "note-99.json: is damaged" in (each["problem"] or ""))
            again = await running.page("operator")
            self.assertEqual((await again.until(lambda each: each["participant"] == "P01"))["notes"], [])
            for page in pages:
                page._conn.transport.abort()

    async def test_a_trial_ends_after_the_last_event_of_its_task(self):
        self.file.write_text(STUDY.replace("{scenario: door, duration_s: 3}", "{scenario: walk_through, duration_s: 30}"))
        async with Running(self.file) as running:
            operator = running.operator
            self.assertIsNone(await operator.ask("begin", code="P01"))
            await go_through(running, lambda each: each["phase"] == "ready")
            self.assertIsNone(await operator.ask("start"))
            state = await operator.until(lambda each: each["run"] and each["run"]["expected_events"])
            self.assertEqual(state["run"]["expected_events"][-1], "shut again")
            state = await operator.until(lambda each: each["last"] is not None)
            self.assertEqual(state["last"]["exit_code"], 0)
        row, = self.table("trials")
        self.assertEqual((row["ended_by"], row["exit_code"]), ("events", "0"))

    async def test_others_are_kept_out(self):
        async with Running(self.file) as running:
            address, _ = running.links["operator"]
            participant = running.links["participant"][1]
            for options in ({"token": "0" * 32}, {"token": participant}, {"origin": "http://elsewhere:80"},
                            {"headers": {"Host": f"elsewhere:{address.rpartition(':')[2]}"}}):
                with self.assertRaises(aiohttp.WSServerHandshakeError, msg=options) as refused:
                    await running.page("operator", **options)
                self.assertEqual(refused.exception.status, 403)
            async with running.client.get(f"{address}/study/operator.html") as page:
                self.assertIn("default-src 'self'", page.headers["Content-Security-Policy"])
            async with running.client.get(f"{address}/../pyproject.toml") as page:
                self.assertEqual(page.status, 404)
            for text in ("{", "[]", '{"command": 3}', '{"id": 1, "command": "_measure"}', '{"id": {}, "command": "note"}'):
                await running.operator.socket.send_str(text)
            self.assertIn("no such command", await running.operator.ask("operator"))
            self.assertIn("no such command", await running.participant.ask("start"))
            with self.assertRaises(aiohttp.WSServerHandshakeError) as refused:
                for _ in range(16):
                    await running.page("participant")
            self.assertEqual(refused.exception.status, 503)
            again = await asyncio.create_subprocess_exec(*running.command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            _, said = await again.communicate()
            self.assertEqual(again.returncode, 2)
            self.assertIn("another program is writing there", said.decode())


if __name__ == "__main__":
    unittest.main()
