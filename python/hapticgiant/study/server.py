"""The two pages of `hapticgiant study run`: operator's and participant's, and their WebSockets.

Whoever has a page's link may use it: the token stands behind # in it, as in that of a run (docs/start/viewer.md).
"""

from __future__ import annotations

import asyncio
import hmac
import json
import pathlib
import secrets
import signal
import traceback
from socket import create_server

from aiohttp import WSMsgType, web

from hapticgiant.study.conductor import AT_ONCE, Conductor, Refused
from hapticgiant.study.folder import FolderError

PROTOCOL = "hapticgiant-study"
LARGEST_MESSAGE = 1 << 18  # bytes
MOST_WAITING = 64  # commands of a page
MOST_SOCKETS = 16  # pages that are open at a time
MOST_STRANGERS = 32  # connections that are no page; these four are those of a run's page, hg/viewer_server
REQUEST_S = 5.0  # from connecting to a whole request
ANSWER_S = 15.0  # until its answer is taken
LARGEST_HEADER = 8192  # bytes
ACCEPT_PAUSE_S = 0.1  # where this program may open no more files
LIVE_PERIOD_S = 0.2
PATIENCE_S = 1.0  # with a page that takes no messages
PAGES = ("operator", "participant")
POLICY = ("default-src 'self'; connect-src 'self'; frame-src http://127.0.0.1:*; img-src 'self' data:; "
          "object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'")
TYPES = {".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".json": "application/json",
         ".svg": "image/svg+xml", ".png": "image/png", ".woff2": "font/woff2", ".wasm": "application/wasm", ".txt": "text/plain"}
HEADERS = {"Content-Security-Policy": POLICY, "Cache-Control": "no-store", "Referrer-Policy": "no-referrer",
           "X-Content-Type-Options": "nosniff", "Cross-Origin-Opener-Policy": "same-origin"}


class Strangers:
    """Connections that are no page, or none yet: few, and none of them for long."""

    def __init__(self):
        self._ends: dict[asyncio.Transport, asyncio.TimerHandle] = {}  # the oldest first

    def admit(self, connection: asyncio.Transport) -> None:
        """A new one; the oldest has to go where there are too many."""
        for each in [each for each in self._ends if each.is_closing()]:
            self.release(each)
        if len(self._ends) >= MOST_STRANGERS:
            oldest = next(iter(self._ends))
            self.release(oldest)
            oldest.abort()
        self._ends[connection] = asyncio.get_running_loop().call_later(REQUEST_S, connection.abort)

    def keep(self, connection: asyncio.Transport | None) -> None:
        """It has sent its request, and is answered."""
        if connection in self._ends:
            self._ends[connection].cancel()
            self._ends[connection] = asyncio.get_running_loop().call_later(ANSWER_S, connection.abort)

    def release(self, connection: asyncio.Transport | None) -> None:
        """It has become a page, or has gone."""
        if end := self._ends.pop(connection, None):
            end.cancel()


class Server:
    """Serves the pages of one study. `conductor` is set before run()."""

    conductor: Conductor

    def __init__(self, pages: pathlib.Path, address: str, port: int):
        self._address, self._port = address, port
        self._files = {f"/{file.relative_to(pages).as_posix()}": file.read_bytes() for file in pages.rglob("*")
                       if file.is_file() and not file.is_symlink()}  # 1 MB, and no other can be asked for
        self._tokens = {name: secrets.token_hex(16) for name in PAGES}
        self._sockets: dict[str, dict[web.WebSocketResponse, web.Request]] = {name: {} for name in PAGES}
        self._news = asyncio.Event()
        self._end = asyncio.Event()
        self._runner: web.AppRunner | None = None
        self._strangers = Strangers()
        self._door: asyncio.Task | None = None

    async def open(self) -> None:
        """Binds the port. Raises OSError."""
        app = web.Application(middlewares=[self._guard])
        for name in PAGES:
            app.router.add_get(f"/ws/{name}", self._talk)
        app.router.add_get("/{file:.*}", self._show)
        self._runner = web.AppRunner(app, access_log=None, lingering_time=0, auto_decompress=False)
        await self._runner.setup()
        listening = create_server((self._address, self._port), backlog=128)
        listening.setblocking(False)
        self._port = listening.getsockname()[1]
        self._door = asyncio.create_task(self._accept(listening))

    async def _accept(self, listening):
        loop = asyncio.get_running_loop()
        while True:
            try:
                connected, _ = await loop.sock_accept(listening)
                connection, _ = await loop.connect_accepted_socket(self._runner.server, connected)
                self._strangers.admit(connection)
            except asyncio.CancelledError:
                listening.close()
                raise
            except Exception as error:  # it has gone, or this program has too many open files
                if not isinstance(error, OSError):
                    traceback.print_exc()
                await asyncio.sleep(ACCEPT_PAUSE_S)

    async def close(self) -> None:
        """Ends all connections."""
        self._door.cancel()
        for sockets in self._sockets.values():
            for socket in list(sockets):
                await socket.close()
        await self._runner.cleanup()

    def origins(self) -> list[str]:
        """Addresses of the pages."""
        own = [f"http://127.0.0.1:{self._port}"]
        if self._address != "127.0.0.1":
            own.append(f"http://{self._address}:{self._port}")
        return own

    def link(self, name: str) -> str:
        return f"{self.origins()[-1]}/study/{name}.html#token={self._tokens[name]}"

    def changed(self) -> None:
        """There is something new to show."""
        self._news.set()

    async def run(self) -> None:
        """Until Ctrl-C or SIGTERM."""
        loop = asyncio.get_running_loop()
        for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            loop.add_signal_handler(each, self._end.set)
        tasks = [asyncio.create_task(self._tell()), asyncio.create_task(self._tell_live())]
        await self._end.wait()
        await self.conductor.close()
        for task in tasks:
            task.cancel()
        await self.close()

    @web.middleware
    async def _guard(self, request, handler):
        self._strangers.keep(request.transport)
        try:
            self._require(request)
            answer = await handler(request)
        except web.HTTPException as error:
            error.headers.update(HEADERS)
            error.force_close()
            raise
        if not answer.prepared:
            answer.headers.update(HEADERS)
            answer.force_close()  # a request for each connection: no one waits for the next
        return answer

    def _require(self, request):
        """Raises HTTPException for a request that no page makes."""
        if not self._is_own(request.host):
            raise web.HTTPForbidden(text="this server is not called that\n")
        if sum(len(name) + len(value) for name, value in request.raw_headers) > LARGEST_HEADER:
            raise web.HTTPRequestHeaderFieldsTooLarge()
        if request.body_exists:
            raise web.HTTPBadRequest(text="expected no body\n")

    def _is_own(self, host):
        """Whether a Host header is an address of this machine: only names can be redirected here by others."""
        name, _, port = host.rpartition(":")
        if port != str(self._port):
            return False
        return name in ("127.0.0.1", "localhost", self._address)

    async def _show(self, request):
        if request.path not in self._files:
            raise web.HTTPNotFound()
        kind = TYPES.get(pathlib.PurePath(request.path).suffix, "application/octet-stream")
        return web.Response(body=self._files[request.path], content_type=kind,
                            charset="utf-8" if kind.startswith("text/") else None)

    async def _talk(self, request):
        name = request.path.rpartition("/")[2]
        asked = [each.strip() for each in request.headers.get("Sec-WebSocket-Protocol", "").split(",")]
        token = next((each.removeprefix("token.") for each in asked if each.startswith("token.")), "")
        origin = request.headers.get("Origin", "")
        if not hmac.compare_digest(token.encode(), self._tokens[name].encode()) or PROTOCOL not in asked:
            raise web.HTTPForbidden(text="the link has another token\n")
        if origin != f"http://{request.host}":
            raise web.HTTPForbidden(text="a page of another server\n")
        if sum(map(len, self._sockets.values())) >= MOST_SOCKETS:
            raise web.HTTPServiceUnavailable(text="too many pages are open\n")
        socket = web.WebSocketResponse(protocols=(PROTOCOL,), max_msg_size=LARGEST_MESSAGE, heartbeat=10)
        await socket.prepare(request)
        self._strangers.release(request.transport)
        self._sockets[name][socket] = request
        self._count()
        orders: asyncio.Queue[dict] = asyncio.Queue(MOST_WAITING)
        worker = asyncio.create_task(self._work(name, socket, orders))
        try:
            await socket.send_json(self._state(name))
            async for message in socket:
                if message.type != WSMsgType.TEXT:
                    continue
                words = read(message.data)
                if words is None:
                    await socket.send_json(answer(None, "expected a JSON object with 'id' and 'command'"))
                elif words["command"] in AT_ONCE:  # overtakes what waits
                    await socket.send_json(await self._take(name, words))
                elif orders.full():
                    await socket.send_json(answer(words, "too many commands at a time"))
                else:
                    orders.put_nowait(words)
        except (ConnectionError, RuntimeError):
            pass  # it has gone
        finally:
            worker.cancel()
            self._sockets[name].pop(socket, None)
            self._count()
        return socket

    async def _work(self, name, socket, orders):
        while True:
            words = await orders.get()
            try:
                await socket.send_json(await asyncio.shield(self._take(name, words)))
            except (ConnectionError, RuntimeError):
                return

    def _count(self):
        self.conductor.participant_pages = len(self._sockets["participant"])
        self.changed()

    async def _take(self, name, words):
        try:
            await getattr(self.conductor, name)(words["command"], words)
            return answer(words, None)
        except (Refused, FolderError, OSError) as error:
            return answer(words, str(error))
        except Exception as error:  # of one command: the study goes on
            traceback.print_exc()
            return answer(words, f"{type(error).__name__}: {error}")

    def _state(self, name):
        if name == "operator":
            return self.conductor.operator_state(self.link("participant"))
        return self.conductor.participant_state()

    async def _tell(self):
        while True:
            await self._news.wait()
            self._news.clear()
            for name, sockets in self._sockets.items():
                if sockets:
                    await self._send(sockets, lambda name=name: self._state(name))

    async def _tell_live(self):
        while True:
            await asyncio.sleep(LIVE_PERIOD_S)
            if self.conductor.run_state() is not None:
                await self._send(self._sockets["operator"], lambda: {"kind": "live", "run": self.conductor.run_state()})

    @staticmethod
    async def _send(sockets, message):
        """Sends what message() gives to all of them. Nothing ends this: the operator has to see."""
        try:
            text = json.dumps(message())
        except Exception:  # a file of the study that cannot be read: the next state may be whole again
            traceback.print_exc()
            return
        for socket, request in list(sockets.items()):
            try:
                await asyncio.wait_for(socket.send_str(text), PATIENCE_S)
            except asyncio.TimeoutError:  # a page that takes nothing holds nobody up
                sockets.pop(socket, None)
                if request.transport is not None:
                    request.transport.abort()
            except Exception:
                sockets.pop(socket, None)  # it has gone


def read(text: str) -> dict | None:
    """The command of a message; None: it is none."""
    try:
        words = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return words if isinstance(words, dict) and isinstance(words.get("command"), str) else None


def answer(words: dict | None, problem: str | None) -> dict:
    """What a page is told of its command; None: done."""
    number = words.get("id") if words else None
    return {"kind": "answer", "id": number if type(number) is int and abs(number) < 1 << 53 else None, "problem": problem}
