"""The server of `hapticgiant study run` towards strangers: who connects and is no page of it.

    server_test.py
"""

import asyncio
import json
import pathlib
import re
import shutil
import tempfile
import unittest
from unittest import mock

import aiohttp
import without_compiled_part  # noqa: F401

from hapticgiant.study import server

HERE = pathlib.Path(__file__).resolve().parent
PAGE_OF_A_RUN = HERE.parents[1] / "hg" / "viewer_server"
BRIEF = {"REQUEST_S": 0.5, "ANSWER_S": 1.5}
PATIENCE_S = 10


class Desk:
    """What the server needs of a conductor."""

    participant_pages = 0

    def operator_state(self, link):
        return {"kind": "state"}

    participant_state = run_state = lambda self: None


class Strangers(unittest.IsolatedAsyncioTestCase):
    async def asyncSetUp(self):
        folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, folder)
        (folder / "small.txt").write_text("a page")
        (folder / "large.txt").write_bytes(b"x" * 20_000_000)
        patches = mock.patch.multiple(server, **BRIEF)
        patches.start()
        self.addCleanup(patches.stop)
        self.server = server.Server(folder, "127.0.0.1", 0)
        self.server.conductor = Desk()
        await self.server.open()
        self.addAsyncCleanup(self.server.close)
        self.address = self.server.origins()[0]
        self.host = self.address.removeprefix("http://")

    async def connected(self, text=""):
        reader, writer = await asyncio.open_connection(*self.host.split(":"), limit=1 << 10)
        self.addCleanup(writer.transport.abort)
        writer.write(text.encode())
        return reader, writer

    async def seconds_until_closed(self, reader):
        """How long it lasts, and what it is sent."""
        begin = asyncio.get_running_loop().time()
        try:
            said = await asyncio.wait_for(reader.read(), PATIENCE_S)
        except ConnectionError:
            said = b""
        return asyncio.get_running_loop().time() - begin, said.decode()

    async def asked(self, head, body=""):
        reader, _ = await self.connected(f"{head} HTTP/1.1\r\nHost: {self.host}\r\n{body}")
        return (await self.seconds_until_closed(reader))[1]

    def test_the_limits_are_those_of_the_page_of_a_run(self):
        texts = "".join((PAGE_OF_A_RUN / name).read_text() for name in ("hub.h", "visitor.h"))
        for own, name in ((5.0, "kStrangerTimeout"), (15.0, "kRequestTimeout"), (server.MOST_STRANGERS, "kMostStrangers"),
                          (server.LARGEST_HEADER, "kLargestHeader")):
            self.assertEqual(own, float(re.search(rf"{name} = (?:std::chrono::seconds\()?(\d+)", texts)[1]), name)
        text = pathlib.Path(server.__file__).read_text()
        self.assertIn("REQUEST_S = 5.0 ", text)
        self.assertIn("ANSWER_S = 15.0 ", text)

    async def test_silence_and_half_a_request_do_not_last(self):
        for text in ("", "GET /small.txt HTTP/1.1\r\nHost: "):
            reader, _ = await self.connected(text)
            self.assertLess((await self.seconds_until_closed(reader))[0], 1.3, text)

    async def test_a_byte_at_a_time_does_not_last(self):
        reader, writer = await self.connected()

        async def drip():
            for each in f"GET /small.txt HTTP/1.1\r\nHost: {self.host}\r\n" + "X: 1\r\n" * 1000:
                writer.write(each.encode())
                await asyncio.sleep(0.01)

        dripping = asyncio.create_task(drip())
        self.assertLess((await self.seconds_until_closed(reader))[0], 1.3)
        dripping.cancel()

    async def test_an_answer_ends_its_connection(self):
        reader, _ = await self.connected(f"GET /small.txt HTTP/1.1\r\nHost: {self.host}\r\n\r\n")
        took, said = await self.seconds_until_closed(reader)
        self.assertLess(took, 1)
        self.assertTrue(said.startswith("HTTP/1.1 200"), said)
        self.assertTrue(said.endswith("a page"), said)
        self.assertTrue((await self.asked("GET /none.txt", "\r\n")).startswith("HTTP/1.1 404"))

    async def test_an_answer_that_is_not_taken_does_not_last(self):
        reader, writer = await self.connected(f"GET /large.txt HTTP/1.1\r\nHost: {self.host}\r\n\r\n")
        await asyncio.sleep(2)
        _, said = await self.seconds_until_closed(reader)
        self.assertLess(len(said), 20_000_000)

    async def test_bodies_and_long_headers_are_refused(self):
        for body in ("Content-Length: 1000000000\r\n\r\nxxx", "Transfer-Encoding: chunked\r\n\r\n5\r\nxxxxx\r\n"):
            self.assertTrue((await self.asked("GET /small.txt", body)).startswith("HTTP/1.1 400"), body)
        long = "".join(f"X-{i}: {'x' * 1000}\r\n" for i in range(9))
        self.assertTrue((await self.asked("GET /small.txt", long + "\r\n")).startswith("HTTP/1.1 431"))

    async def test_silent_connections_block_no_other_and_pages_stay(self):
        patience = mock.patch.object(server, "REQUEST_S", PATIENCE_S)
        patience.start()
        self.addCleanup(patience.stop)
        own = self.server.link("operator").rpartition("=")[2]
        async with aiohttp.ClientSession() as client:
            page = await client.ws_connect(f"{self.address}/ws/operator", origin=self.address,
                                           protocols=(server.PROTOCOL, f"token.{own}"))
            self.addAsyncCleanup(page.close)
            silent = [await self.connected() for _ in range(100)]
            self.assertTrue((await self.asked("GET /small.txt", "\r\n")).startswith("HTTP/1.1 200"))
            self.assertLess((await self.seconds_until_closed(silent[0][0]))[0], 1)
            await asyncio.sleep(2)
            await page.send_str("{")
            said = [json.loads((await page.receive(PATIENCE_S)).data)["kind"] for _ in range(2)]
            self.assertEqual(said, ["state", "answer"])


if __name__ == "__main__":
    unittest.main()
