"""A small reader of OpenEXR files: one part, scan lines, uncompressed or ZIP, any channels.

Written from the file layout document of OpenEXR. Anything else is refused with ValueError.
"""
import itertools
import struct
import zlib

MAGIC = 20000630
LINES_IN_BLOCK = {0: 1, 2: 1, 3: 16}  # none, ZIPS, ZIP
PIXEL_TYPES = {0: ("I", 4), 1: ("e", 2), 2: ("f", 4)}  # uint, half, float


class Image:
    """Channels by name, each a list of rows; `types` says "I", "e" (half) or "f" of each channel."""

    def __init__(self, header, channels, types):
        self.header, self.channels, self.types = header, channels, types
        x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
        self.origin, self.width, self.height = (x0, y0), x1 - x0 + 1, y1 - y0 + 1

    def at(self, name, i, j):
        """The value of a channel at pixel (i, j) of the display window."""
        return self.channels[name][j - self.origin[1]][i - self.origin[0]]

    def vector(self, names, i, j):
        """The values of several channels at one pixel."""
        return [self.at(name, i, j) for name in names]


def text_until_zero(data, at):
    """(string, position after its terminating zero)."""
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def read_header(data):
    """(attributes as raw bytes by name, position after the header)."""
    magic, version = struct.unpack_from("<ii", data, 0)
    if magic != MAGIC:
        raise ValueError("not an OpenEXR file")
    if version & 0x1A00:
        raise ValueError("deep, tiled or multi-part files are not read here")
    at, header = 8, {}
    while data[at] != 0:
        name, at = text_until_zero(data, at)
        _, at = text_until_zero(data, at)
        size, = struct.unpack_from("<i", data, at)
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return header, at + 1


def read_channel_list(raw):
    """[(name, pixel type)] in file order."""
    at, channels = 0, []
    while raw[at] != 0:
        name, at = text_until_zero(raw, at)
        kind, _, x_step, y_step = struct.unpack_from("<iIii", raw, at)
        if (x_step, y_step) != (1, 1):
            raise ValueError("subsampled channels are not read here")
        channels.append((name, PIXEL_TYPES[kind]))
        at += 16
    return channels


def unzipped(block, size):
    """The bytes of a ZIP block: inflate, undo the delta coding, then the split into halves."""
    if len(block) == size:
        return block
    deltas = zlib.decompress(block)
    values = bytes(itertools.accumulate(deltas, lambda a, b: (a + b - 128) & 255))
    whole = bytearray(size)
    half = (size + 1) // 2
    whole[0::2], whole[1::2] = values[:half], values[half:]
    return bytes(whole)


def read(path):
    """The image in a file."""
    with open(path, "rb") as stream:
        data = stream.read()
    header, at = read_header(data)
    channels = read_channel_list(header["channels"])
    compression = header["compression"][0]
    if compression not in LINES_IN_BLOCK:
        raise ValueError(f"compression {compression} is not read here")
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height, lines = x1 - x0 + 1, y1 - y0 + 1, LINES_IN_BLOCK[compression]
    row_bytes = width * sum(size for _, (_, size) in channels)
    rows = {name: [None] * height for name, _ in channels}
    offsets = struct.unpack_from(f"<{-(-height // lines)}Q", data, at)
    for offset in offsets:
        y, size = struct.unpack_from("<ii", data, offset)
        count = min(lines, y1 - y + 1)
        block = unzipped(data[offset + 8:offset + 8 + size], count * row_bytes)
        position = 0
        for line in range(y - y0, y - y0 + count):
            for name, (code, bytes_each) in channels:
                rows[name][line] = struct.unpack_from(f"<{width}{code}", block, position)
                position += width * bytes_each
    return Image(header, rows, {name: code for name, (code, _) in channels})
