"""A recording by the official MCAP reader: what exports and streams are compared with."""

import numpy as np
from mcap.reader import NonSeekingReader
from mcap_ros2.decoder import DecoderFactory


def messages(file, topic):
    """Log times in ns and decoded messages."""
    with open(file, "rb") as stream:
        reader = NonSeekingReader(stream, decoder_factories=[DecoderFactory()])
        return [(message.log_time, decoded) for _, _, message, decoded
                in reader.iter_decoded_messages([topic], log_time_order=False)]


def samples(file):
    return [sample for _, sample in messages(file, "/hapticgiant/sample")]


def events(file):
    return [(event.time_s, event.name, event.text)
            for _, event in messages(file, "/hapticgiant/events")]


def lab_clock(file):
    """Offsets of the clock of the Lab Streaming Layer, in their order."""
    return [clock.offset_s for _, clock in messages(file, "/hapticgiant/lab_clock")]


def quaternion(rotation):
    """x, y, z, w of a rotation matrix, row by row, by its largest component."""
    r = np.reshape(rotation, (3, 3))
    squared = np.array([1 + r[0, 0] - r[1, 1] - r[2, 2], 1 - r[0, 0] + r[1, 1] - r[2, 2],
                        1 - r[0, 0] - r[1, 1] + r[2, 2], 1 + np.trace(r)])
    largest = int(np.argmax(squared))
    rows = [[squared[0], r[1, 0] + r[0, 1], r[0, 2] + r[2, 0], r[2, 1] - r[1, 2]],
            [r[1, 0] + r[0, 1], squared[1], r[2, 1] + r[1, 2], r[0, 2] - r[2, 0]],
            [r[0, 2] + r[2, 0], r[2, 1] + r[1, 2], squared[2], r[1, 0] - r[0, 1]],
            [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], squared[3]]]
    return np.array(rows[largest]) / (2 * np.sqrt(squared[largest]))
