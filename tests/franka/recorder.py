"""A recorder between a client and a robot: everything that goes through it is handed on and kept.

The client connects to Recorder.host at port 1337, which libfranka always takes. Only the UDP port in
Connect is replaced, so that states pass through here, too.
"""

import random
import select
import socket
import struct
import threading

PORT = 1337
HEADER = struct.Struct("<III")  # command, number, size of the whole message
CONNECT = 0
FINISHED = 370  # place of torque_command_finished in a command of a motion
LARGEST = 65536


def listener():
    """A listening socket at some address of this computer whose port 1337 is free."""
    while True:
        one = socket.socket()
        one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            one.bind((f"127.0.{random.randint(1, 254)}.{random.randint(1, 254)}", PORT))
            one.listen(1)
            return one
        except OSError:
            one.close()


class Recorder:
    """Context manager; the robot is at 127.0.0.1:`port`."""

    def __init__(self, port, keeps_finished=False):
        self.port = port
        self.keeps_finished = keeps_finished  # hides from the robot that the torques are over
        self.requests = []  # (command, body) of the client
        self.answers = []  # (command, first byte of the body: its status)
        self.commands = []  # datagrams of the client
        self.states = 0
        self.listener = listener()
        self.host = self.listener.getsockname()[0]
        self.stopped = threading.Event()
        self.thread = threading.Thread(target=self._live)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.stopped.set()
        self.thread.join()
        self.listener.close()

    def of(self, command):
        """Bodies of this command, in order."""
        return [body for kind, body in self.requests if kind == command]

    def _live(self):
        self.listener.settimeout(0.05)
        while not self.stopped.is_set():
            try:
                client, address = self.listener.accept()
            except TimeoutError:
                continue
            with client, socket.create_connection(("127.0.0.1", self.port)) as robot:
                self._serve(client, address[0], robot)

    def _serve(self, client, client_host, robot):
        for stream in (client, robot):
            stream.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        with socket.socket(type=socket.SOCK_DGRAM) as outer, \
                socket.socket(type=socket.SOCK_DGRAM) as inner:
            outer.bind((self.host, 0))  # a client takes states from the address it knows alone
            inner.bind(("127.0.0.1", 0))
            ends = {"client": None, "robot": None}  # where datagrams go
            waiting = {client: b"", robot: b""}
            while not self.stopped.is_set():
                for one in select.select([client, robot, outer, inner], [], [], 0.05)[0]:
                    if one is inner:
                        state, ends["robot"] = inner.recvfrom(LARGEST)
                        self.states += 1
                        if ends["client"]:
                            outer.sendto(state, ends["client"])
                    elif one is outer:
                        command = outer.recv(LARGEST)
                        self.commands.append(command)
                        if ends["robot"] and not (self.keeps_finished and command[FINISHED]):
                            inner.sendto(command, ends["robot"])
                    else:
                        try:
                            new = one.recv(LARGEST)
                        except ConnectionError:
                            new = b""
                        if not new:
                            return
                        waiting[one] += new
                        while message := self._take(waiting, one):
                            if one is robot:
                                self.answers.append((HEADER.unpack_from(message)[0],
                                                     message[HEADER.size]))
                                client.sendall(message)
                                continue
                            command = HEADER.unpack_from(message)[0]
                            body = message[HEADER.size:]
                            self.requests.append((command, body))
                            if command == CONNECT:
                                version, port = struct.unpack("<HH", body)
                                ends["client"] = (client_host, port)
                                body = struct.pack("<HH", version, inner.getsockname()[1])
                            robot.sendall(message[:HEADER.size] + body)

    @staticmethod
    def _take(waiting, stream):
        """The next whole message that has come, or nothing."""
        have = waiting[stream]
        if len(have) < HEADER.size:
            return b""
        size = HEADER.unpack_from(have)[2]
        if len(have) < size:
            return b""
        waiting[stream] = have[size:]
        return have[:size]
