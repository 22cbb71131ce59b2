"""The master SOEM (pysoem) behind commands on standard input, as ethercrab_master has them.

    pysoem_master.py INTERFACE

One command a line, one line of JSON as answer; ethercat_test.py describes them.
"""

import json
import sys
import time

import pysoem

PERIOD_NS = 1_000_000
PATIENCE_US = 5_000_000


class SoemMaster:
    def __init__(self, interface):
        # its own are for real slaves: a busy computer answers later
        timeouts = pysoem.settings.timeouts
        timeouts.ret, timeouts.safe, timeouts.eeprom = 300_000, 1_000_000, 1_000_000
        timeouts.tx_mailbox = timeouts.rx_mailbox = timeouts.state = PATIENCE_US
        self.master = pysoem.Master()
        self.master.sdo_read_timeout = self.master.sdo_write_timeout = PATIENCE_US
        self.master.open(interface)

    def scan(self):
        if self.master.config_init() <= 0:
            return []
        # measures the delays
        self.master.config_dc()
        return [{"name": slave.name, "vendor": slave.man, "product": slave.id,
                 "revision": slave.rev, "delay_ns": self.register_of(slave, 0x0928, 4)}
                for slave in self.master.slaves]

    def register_of(self, slave, address, size):
        """A register as a number; 0: the slave does not have it."""
        try:
            return int.from_bytes(slave._fprd(address, size, PATIENCE_US), "little")
        except pysoem.WkcError:
            return 0

    def read(self, i, index, subindex, size):
        try:
            read = self.master.slaves[int(i)].sdo_read(int(index, 0), int(subindex))
            return read[:int(size)].hex()
        except pysoem.SdoError as error:
            return {"abort": error.abort_code}

    def write(self, i, index, subindex, data):
        try:
            self.master.slaves[int(i)].sdo_write(int(index, 0), int(subindex), bytes.fromhex(data))
            return {}
        except pysoem.SdoError as error:
            return {"abort": error.abort_code}

    def configure(self):
        for slave in self.master.slaves:
            if self.register_of(slave, 0x0910, 4):  # it has a clock
                slave.dc_sync(True, PERIOD_NS)
        self.master.config_map()
        if self.master.state_check(pysoem.SAFEOP_STATE, PATIENCE_US) != pysoem.SAFEOP_STATE:
            raise RuntimeError(f"not in SAFE-OP: {self.states()}")
        return [[len(slave.output), len(slave.input)] for slave in self.master.slaves]

    def operate(self):
        self.master.state = pysoem.OP_STATE
        self.master.write_state()
        until = time.monotonic() + PATIENCE_US * 1e-6
        while self.master.state_check(pysoem.OP_STATE, 1000) != pysoem.OP_STATE:
            self.master.send_processdata()
            self.master.receive_processdata(PATIENCE_US)
            if time.monotonic() > until:
                raise RuntimeError(f"not in OP: {self.states()}")
        return {}

    def cycle(self, patience_ms, outputs):
        for slave, data in zip(self.master.slaves, outputs.split(",")):
            if data != "-":
                slave.output = bytes.fromhex(data)
        self.master.send_processdata()
        counter = self.master.receive_processdata(int(patience_ms) * 1000)
        if counter < 0:
            return {"counter": None}
        return {"counter": counter, "inputs": [slave.input.hex() for slave in self.master.slaves]}

    def states(self):
        states = []
        for slave in self.master.slaves:
            try:
                status, _, code = (int.from_bytes(slave._fprd(address, 2, PATIENCE_US), "little")
                                   for address in (0x0130, 0x0132, 0x0134))
                states.append([status & 0x1F, code])
            except pysoem.WkcError:
                states.append(None)
        return states

    def register(self, i, address, data):
        self.master.slaves[int(i)]._fpwr(int(address, 0), bytes.fromhex(data),
                                                  PATIENCE_US)
        return {}


def main():
    master = SoemMaster(sys.argv[1])
    for line in sys.stdin:
        name, *arguments = line.split()
        try:
            answer = getattr(master, name)(*arguments)
        except Exception as error:  # the answer says so, and the next command may work
            answer = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
