#!/usr/bin/env python3
"""Marks a video as one to look around in: the metadata by which players know a spherical video.

    scripts/spherical.py VIDEO.mp4 [--projection equirectangular|cubemap] [--stereo none|top-bottom]

The boxes are those of Google's Spherical Video V2 RFC (st3d and sv3d in the sample entry of each video track), and for
older players, of equirectangular videos, V1's XML in a uuid box of the track. What was there of them is replaced. The
file is written anew beside itself and renamed; the pictures stay as they are. ffmpeg 5.1 reads these boxes, and writes
them only for streams that come with them.
"""
import argparse
import os
import struct
import sys

V1_UUID = bytes.fromhex("ffcc8263f8554a938814587a02521fdd")
CONTAINERS = {b"moov", b"trak", b"mdia", b"minf", b"stbl"}
VISUAL_ENTRY = 78  # bytes of a sample entry before its boxes (ISO/IEC 14496-12, VisualSampleEntry)


class NotMp4(Exception):
    """What keeps a file from being marked."""


def boxes_of(data):
    """The boxes in these bytes, as (kind, content) pairs."""
    place = 0
    while place < len(data):
        if len(data) - place < 8:
            raise NotMp4("a box is cut short")
        size, kind = struct.unpack(">I4s", data[place:place + 8])
        head = 8
        if size == 1:
            size, head = struct.unpack(">Q", data[place + 8:place + 16])[0], 16
        elif size == 0:
            size = len(data) - place
        if size < head or place + size > len(data):
            raise NotMp4(f"the box '{kind.decode('latin-1')}' is cut short")
        yield kind, data[place + head:place + size]
        place += size


def raw_boxes_of(data):
    """The same with their heads, as they are: a long size stays long."""
    raw, place = [], 0
    for _ in boxes_of(data):
        size = struct.unpack(">I", data[place:place + 4])[0]
        end = place + (struct.unpack(">Q", data[place + 8:place + 16])[0] if size == 1 else size or len(data) - place)
        raw.append(data[place:end])
        place = end
    return raw


def box(kind, content):
    """A box; of more than 4 GB with a long size."""
    if len(content) + 8 < 1 << 32:
        return struct.pack(">I4s", len(content) + 8, kind) + content
    return struct.pack(">I4sQ", 1, kind, len(content) + 16) + content


def full(kind, content):
    """A box of version 0 without flags."""
    return box(kind, bytes(4) + content)


def marks(projection, top_bottom):
    """st3d and sv3d: no pose, and no bounds, since the whole sphere is there."""
    shape = full(b"equi", bytes(16)) if projection == "equirectangular" else full(b"cbmp", bytes(8))
    header = full(b"prhd", bytes(12))
    return full(b"st3d", bytes([1 if top_bottom else 0])) + box(
        b"sv3d", full(b"svhd", b"Backlight\0") + box(b"proj", header + shape))


def xml(top_bottom):
    """V1, which knows equirectangular videos only."""
    stereo = "<GSpherical:StereoMode>top-bottom</GSpherical:StereoMode>" if top_bottom else ""
    return ('<?xml version="1.0"?><rdf:SphericalVideo xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#" '
            'xmlns:GSpherical="http://ns.google.com/videos/1.0/spherical/">'
            "<GSpherical:Spherical>true</GSpherical:Spherical><GSpherical:Stitched>true</GSpherical:Stitched>"
            "<GSpherical:StitchingSoftware>Backlight</GSpherical:StitchingSoftware>"
            "<GSpherical:ProjectionType>equirectangular</GSpherical:ProjectionType>"
            f"{stereo}</rdf:SphericalVideo>").encode()


def is_video(track):
    """Whether a track's handler is that of pictures."""
    for kind, content in boxes_of(track):
        if kind == b"mdia":
            return any(k == b"hdlr" and c[8:12] == b"vide" for k, c in boxes_of(content))
    return False


def marked_entry(content, new):
    """A sample entry with the marks at its end."""
    kept = b"".join(box(k, c) for k, c in boxes_of(content[VISUAL_ENTRY:]) if k not in (b"st3d", b"sv3d"))
    return content[:VISUAL_ENTRY] + kept + new


def rebuilt(content, kind, args, shift, video=False):
    """The content of a box of the movie, marked; chunk offsets are moved by `shift`."""
    if kind in CONTAINERS:
        parts = []
        for inner, inside in boxes_of(content):
            if inner == b"uuid" and kind == b"trak" and inside.startswith(V1_UUID):
                continue
            video_inside = is_video(inside) if inner == b"trak" else video
            parts.append(box(inner, rebuilt(inside, inner, args, shift, video_inside)))
        if kind == b"trak" and video and args.projection == "equirectangular":
            parts.append(box(b"uuid", V1_UUID + xml(args.stereo == "top-bottom")))
        return b"".join(parts)
    if kind == b"stsd" and video:
        new = marks(args.projection, args.stereo == "top-bottom")
        return content[:8] + b"".join(box(k, marked_entry(c, new)) for k, c in boxes_of(content[8:]))
    if kind in (b"stco", b"co64"):
        letter = "I" if kind == b"stco" else "Q"
        count = struct.unpack(">I", content[4:8])[0]
        places = struct.unpack(f">{count}{letter}", content[8:])
        return content[:8] + struct.pack(f">{count}{letter}", *(place + shift for place in places))
    return content


def marked(data, args):
    """The whole file, marked."""
    top = list(boxes_of(data))
    others = raw_boxes_of(data)
    kinds = [kind for kind, _ in top]
    if b"ftyp" not in kinds or b"moov" not in kinds or b"mdat" not in kinds:
        raise NotMp4("it is no MP4 with a movie in one piece")
    movie = top[kinds.index(b"moov")][1]
    if not any(kind == b"trak" and is_video(content) for kind, content in boxes_of(movie)):
        raise NotMp4("it has no video track")
    longer = len(rebuilt(movie, b"moov", args, 0)) - len(movie)
    # Samples move only if the movie box is before them.
    shift = longer if kinds.index(b"moov") < kinds.index(b"mdat") else 0
    return b"".join(box(k, rebuilt(c, k, args, shift)) if k == b"moov" else raw for (k, c), raw in zip(top, others))


def main():
    """Reads the arguments; the exit status is 4 where the file cannot be read, marked or written."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("video")
    parser.add_argument("--projection", choices=["equirectangular", "cubemap"], default="equirectangular")
    parser.add_argument("--stereo", choices=["none", "top-bottom"], default="none")
    args = parser.parse_args()
    partial = f"{args.video}.marked.{os.getpid()}"
    try:
        with open(args.video, "rb") as file:
            data = marked(file.read(), args)
        with open(partial, "wb") as file:
            file.write(data)
        os.replace(partial, args.video)
    except (OSError, NotMp4, struct.error) as error:
        if os.path.exists(partial):
            os.remove(partial)
        print(f"scripts/spherical.py: {args.video}: {error}", file=sys.stderr)
        return 4
    return 0


if __name__ == "__main__":
    sys.exit(main())
