"""A page as far as tests of the program need one: HTTP and a WebSocket on a plain socket."""

import json
import os
import re
import socket
import struct
import threading
import time

PATIENCE_S = 30.0


class WebSocket:
    """A connection to a server of this program at `host`, "127.0.0.1:8080"."""

    def __init__(self, host, path, protocol, origin=""):
        self.host = host
        name, _, port = host.rpartition(":")
        self.address = (name, int(port))
        self.socket = socket.create_connection(self.address, timeout=PATIENCE_S)
        self.received = b""
        self.send_text(f"GET {path} HTTP/1.1\r\nHost: {host}\r\n{origin}Connection: Upgrade\r\n"
                       "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                       f"Sec-WebSocket-Protocol: {protocol}\r\n"
                       "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n")
        head = self.read_until(b"\r\n\r\n")
        assert head.startswith(b"HTTP/1.1 101"), head
        self.sending = threading.Lock()

    def close(self):
        self.socket.close()

    def send_text(self, text):
        self.socket.sendall(text.encode())

    def read_until(self, end):
        while end not in self.received:
            self.receive()
        head, _, self.received = self.received.partition(end)
        return head

    def receive(self):
        chunk = self.socket.recv(65536)
        if not chunk:
            raise EOFError("the program has closed the connection")
        self.received += chunk

    def take(self, size):
        while len(self.received) < size:
            self.receive()
        taken, self.received = self.received[:size], self.received[size:]
        return taken

    def take_message(self):
        """Opcode and bytes of the next message."""
        opcode, is_last, data = self.take_frame()
        while not is_last:
            _, is_last, more = self.take_frame()
            data += more
        return opcode, data

    def take_frame(self):
        first, length = self.take(2)
        size = length & 127
        if size == 126:
            size = struct.unpack(">H", self.take(2))[0]
        return first & 15, first & 128 != 0, self.take(size)

    def send(self, message):
        """`message` may be a text that is no JSON."""
        self.send_data((message if isinstance(message, str) else json.dumps(message)).encode())

    def send_data(self, data, opcode=1):
        mask = os.urandom(4)
        length = bytes([0x80 | len(data)]) if len(data) < 126 else b"\xfe" + struct.pack(
            ">H", len(data))
        with self.sending:
            self.socket.sendall(bytes([0x80 | opcode]) + length + mask +
                                bytes(byte ^ mask[i % 4] for i, byte in enumerate(data)))


class Page(WebSocket):
    """Connected to the page of a program that printed `link`."""

    def __init__(self, link):
        host, self.token = re.match(r"http://([^/]+)/#token=(\w+)", link).groups()
        super().__init__(host, "/ws", f"hapticgiant, token.{self.token}",
                         f"Origin: http://{host}\r\n")
        self.last_id = 0
        self.skipped = []  # messages other than frames that were not requested yet
        self.number = self.next("welcome")["page"]
        self.sequence = 0  # of the last heartbeat

    def answer_to(self, path):
        """The answer to a GET, with its headers."""
        with socket.create_connection(self.address, timeout=PATIENCE_S) as connection:
            connection.sendall(f"GET {path} HTTP/1.1\r\nHost: {self.host}\r\n"
                               f"Authorization: Bearer {self.token}\r\n"
                               "Connection: close\r\n\r\n".encode())
            answer = b""
            while chunk := connection.recv(65536):
                answer += chunk
        return answer.decode()

    def get(self, path):
        return self.answer_to(path).partition("\r\n\r\n")[2]

    def scene(self):
        return json.loads(self.get("/scene.json"))

    def hold(self, until):
        """Reports every 30 ms that it is there, until the event is set; from another thread."""
        while not until.wait(0.03):
            self.sequence += 1
            self.send({"type": "hold", "sequence": self.sequence})

    def next(self, kind, when=lambda message: True):
        """The next message of this type for which `when` holds; others but frames are kept."""
        for i, message in enumerate(self.skipped):
            if message["type"] == kind and when(message):
                return self.skipped.pop(i)
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            opcode, data = self.take_message()
            if opcode == 9:
                self.send_data(data, opcode=10)  # pong
                continue
            assert opcode == 1, data
            message = json.loads(data)
            if message["type"] == kind and when(message):
                return message
            if message["type"] != "frame":
                self.skipped.append(message)
        raise TimeoutError(f"no {kind} as expected")

    def command(self, command, name="", value=0):
        """The answer of the program."""
        self.last_id += 1
        self.send({"type": "command", "id": self.last_id, "command": command, "name": name,
                   "value": value})
        return self.next("answer", lambda answer: answer["id"] == self.last_id)


class Live(WebSocket):
    """A client of the live interface of the program that serves `page`."""

    def __init__(self, page):
        super().__init__(page.host, f"/live?token={page.token}", "foxglove.sdk.v1")

    def warning(self):
        """The text of the next warning."""
        while True:
            opcode, data = self.take_message()
            message = json.loads(data) if opcode == 1 else {}
            if message.get("op") == "status" and message["level"] > 0:
                return message["message"]
