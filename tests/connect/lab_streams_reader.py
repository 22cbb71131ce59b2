"""Reads the streams of a run by pylsl: lab_streams_reader.py OUT.npz

Prints "looking" when it begins to look for them, and "ready" once both streams are open; ends when no
sample has come for two seconds.
"""

import sys
import time

import numpy as np
import pylsl


def labels(info):
    channel = info.desc().child("channels").child("channel")
    found = []
    for _ in range(info.channel_count()):
        found.append((channel.child_value("label"), channel.child_value("unit")))
        channel = channel.next_sibling()
    return found


def main():
    print("looking", flush=True)
    inlets = []
    for name in ("HapticGiant", "HapticGiantEvents"):
        (info,) = pylsl.resolve_byprop("name", name, minimum=1, timeout=60)
        inlets.append(pylsl.StreamInlet(info, max_buflen=60))
        inlets[-1].open_stream(timeout=60)
    info = inlets[0].info(timeout=60)
    print("ready", flush=True)
    values, times, texts, text_times, delays = [], [], [], [], []
    last = time.monotonic()
    while time.monotonic() < last + 2.0:
        chunk, stamps = inlets[0].pull_chunk(timeout=0.2, max_samples=1000)
        if stamps:
            last = time.monotonic()
            delays.append(pylsl.local_clock() - stamps[-1])
            values.extend(chunk)
            times.extend(stamps)
        chunk, stamps = inlets[1].pull_chunk()
        texts.extend(text for (text,) in chunk)
        text_times.extend(stamps)
    np.savez(sys.argv[1], values=np.array(values), times=np.array(times), texts=np.array(texts),
             text_times=np.array(text_times), delays=np.array(delays),
             labels=np.array(labels(info)), rate=info.nominal_srate(), type=info.type())


if __name__ == "__main__":
    main()
